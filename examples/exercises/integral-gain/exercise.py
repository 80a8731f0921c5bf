"""The integral gain of a PI controller from its integral time."""

from replicate.exhibits.variants import Answer, rounded

original = {"k": 0.9, "Ti": 3.0}  # the numbers of the handout that all share; without them, a draw
stated = "Carry on with at least two significant digits, and state $k_i$ with three."
requires = {
    "k and Ti are not near one": lambda x: abs(x["k"] - 1) > 0.05 and abs(x["Ti"] - 1) > 0.05,
}


def variant(rng):
    """Draw a gain and an integral time of two digits."""
    return {"k": rng.randint(2, 30) / 10, "Ti": rng.randint(5, 60) / 10}


def answers(inputs):
    """Return the integral gain, carried on with an inverse of two digits."""
    k, ti = inputs["k"], inputs["Ti"]
    return Answer(
        k / ti,
        digits=3,
        carried=(k * rounded(1 / ti, 2),),
        mistakes={"multiplied": k * ti, "gain forgotten": 1 / ti},
        asked="$k_i$",
    )
