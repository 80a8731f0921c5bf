"""Skogestad's paper on the SIMC rules: the robustness margins that follow from them."""

from replicate.exhibits import Paper

paper = Paper(
    id="skogestad2003",
    package=__name__,
    title="Simple analytic rules for model reduction and PID controller tuning",
    authors=("Sigurd Skogestad",),
    citation=(
        "S. Skogestad, “Simple analytic rules for model reduction and PID controller tuning”, "
        "Journal of Process Control, 13, 291–309, 2003."
    ),
    year=2003,
    modules=("table_1", "nyquist", "claims"),
    numbered=("table-1",),
    summary="The robustness margins of the SIMC rules hold to the last digit when the dead time is treated exactly.",
)
