"""Papers III to VI: loop shaping, steam generator, industrial evaluations, active damping."""

MODULES: tuple[str, ...] = (
    "iii_diagrams",
    "iii_examples",
    "iii_figures",
    "iii_eq_5_14",
    "iii_table_1",
    "iii_claims",
    "iii_claims_contour",
    "iii_claims_example_2",
    "iv_steam_generator",
    "iv_claims",
    "v_figures",
    "v_models",
    "v_starch",
    "v_drying",
    "v_claims",
    "vi_figures",
    "vi_example",
    "vi_regression",
    "vi_claims",
)
NUMBERED: tuple[str, ...] = (
    *(f"III-fig-{n}" for n in range(1, 7)),
    "III-table-1",
    "III-example-1",
    "III-example-2",
    *(f"IV-fig-{n}" for n in range(1, 11)),
    "IV-table-1",
    "IV-table-2",
    *(f"V-fig-{n}" for n in range(1, 10)),
    *(f"VI-fig-{n}" for n in range(1, 9)),
)
