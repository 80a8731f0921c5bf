"""Paper II and its supplement: PID design by constrained optimisation."""

MODULES: tuple[str, ...] = (
    "fig_1",
    "tables",
    "filter_grids",
    "fig_2_3",
    "recommended",
    "surface_figures",
    "example",
    "example_figures",
    "filter_table",
    "noise_figures",
    "setpoint_formulas",
    "errata_table",
    "settling",
    "two_peaks",
    "claims",
    "robustness_claims",
    "parameter_claims",
    "supplement_claims",
    "setpoint_claims",
)
NUMBERED: tuple[str, ...] = (
    "II-fig-1",
    "II-table-1",
    "II-fig-2",
    "II-fig-3",
    *(f"IIs-fig-{n}" for n in range(1, 9)),
    "IIs-table-1",
    "IIs-table-2",
    "IIs-example",
    "IIs-eq-13-16",
)
