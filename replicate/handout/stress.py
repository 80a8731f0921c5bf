"""A stress test of exercises whose numbers vary: every form is solvable, and no common mistake is accepted."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from statistics import median

from replicate.errors import PaperDefinitionError
from replicate.exhibits.variants import Answer, Variation, rounded

ENOUGH = 100  # draws, from which on a share of them says something
LARGEST_SHARE = 0.3  # of one stated answer; above it a class would soon know what to guess


def stressed(variation: Variation, draws: int) -> Iterator[str]:
    """Yield a line on the distribution of each answer.

    Parameters
    ----------
    draws
        How many forms are drawn.

    Raises
    ------
    PaperDefinitionError
        If a form cannot be drawn or has no answer, a mistake is accepted, an answer stated as asked for is not,
        or one answer is so frequent that it can be guessed.
    """
    found: dict[str, list[Answer]] = defaultdict(list)
    for number in range(draws):
        inputs = variation.drawn(f"stress\0{number}")
        for part, answer in variation.answers(inputs).items():
            drawn = ", ".join(f"{name} = {value}" for name, value in inputs.items())
            where = f"exercise '{variation.name}', {part}, with {drawn}"
            wrong = next((words for words, value in answer.mistakes.items() if answer.accepts(value)), None)
            if wrong:
                msg = f"{where}: the mistake '{wrong}' ({answer.mistakes[wrong]:g}) is accepted"
                raise PaperDefinitionError(msg)
            missed = [path for path in (answer.value, *answer.carried) if not answer.accepts(_stated(answer, path))]
            if missed:
                msg = f"{where}: {_stated(answer, missed[0]):g}, stated as the exercise asks, is not accepted"
                raise PaperDefinitionError(msg)
            found[part].append(answer)
    for part, answers in found.items():
        counts = Counter(_stated(answer, answer.value) for answer in answers)
        frequent, times = counts.most_common(1)[0]
        share = times / len(answers)
        if len(answers) >= ENOUGH and share > LARGEST_SHARE:
            msg = f"exercise '{variation.name}', {part}: {frequent:g} is the answer of {share:.0%} of the forms"
            raise PaperDefinitionError(msg)
        yield (
            f"{variation.name}, {part}: {len(counts)} answers in {len(answers)} forms, from {min(counts):g} to "
            f"{max(counts):g}, median {median(counts.elements()):g}, the most frequent in {share:.1%}"
        )


def _stated(answer: Answer, value: float) -> float:
    """Return a value as a careful student would write it down."""
    if answer.digits is not None:
        return rounded(value, answer.digits)
    assert answer.tolerance is not None  # noqa: S101  -- for the type checker
    return round(value / answer.tolerance) * answer.tolerance
