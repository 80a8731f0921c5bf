"""Balmer's note of 1885: one formula for the four visible lines of hydrogen."""

from replicate.exhibits import Paper

paper = Paper(
    id="balmer1885",
    package=__name__,
    title="Note on the spectral lines of hydrogen",
    authors=("Johann Jakob Balmer",),
    citation=(
        "J. J. Balmer, “Notiz über die Spectrallinien des Wasserstoffs”, "
        "Annalen der Physik und Chemie, 25, 80–87, 1885."
    ),
    year=1885,
    modules=("lines", "spectrum", "claims"),
    numbered=("hydrogen-lines",),
    summary="Every wavelength and difference of the note holds to the last digit.",
)
