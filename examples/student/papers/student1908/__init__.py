"""Student's paper on the mean of a small sample: the table of additional hours of sleep."""

from replicate.exhibits import Paper

paper = Paper(
    id="student1908",
    package=__name__,
    title="The probable error of a mean",
    authors=("Student",),
    citation="Student, “The probable error of a mean”, Biometrika, 6(1), 1–25, 1908.",
    year=1908,
    modules=("illustration_1", "sleep_gained", "claims"),
    numbered=("illustration-1",),
    summary=(
        "The table of Illustration I holds to the last digit, with a standard deviation that is divided by the number "
        "of patients. A reader who divides by one less, as most programs do, needs to know that."
    ),
)
