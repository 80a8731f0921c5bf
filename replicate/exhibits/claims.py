"""The sentences of a paper that can be true or false, and what checking them finds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, get_args

from replicate.exhibits.definitions import check_function, check_id, check_one_of, check_texts
from replicate.exhibits.order import module_being_imported

ClaimVerdict = Literal["holds", "fails", "holds-partly", "undecided"]
Consequence = Literal["none", "comparison", "safety", "formula"]


@dataclass(frozen=True)
class Finding:
    """What a claim's check found: the verdict, the number that decides it, and the evidence in one or two sentences.

    Attributes
    ----------
    verdict
        ``undecided`` where the paper gives too little to call the sentence true or false; the evidence says what is
        missing.
    value
        The computed number that decides it.
    evidence
        One or two sentences, in Markdown.
    """

    verdict: ClaimVerdict
    value: float
    evidence: str


@dataclass(frozen=True)
class Claim:
    """A sentence of the paper that can be true or false.

    Attributes
    ----------
    id
        A short ASCII slug.
    text
        The claim in our own words, in Markdown.
    check
        Returns the finding.
    where
        Section or page.
    printed
        The number that the sentence names, if it names one.
    consequence
        What follows if it is not true: ``comparison`` (a ranking or an inequality of the paper flips), ``safety`` (a
        statement about stability or robustness does), ``formula`` (the printed formula gives a wrong controller), or
        ``none``.
    module
        The module in which it is defined; set by itself.
    """

    id: str
    text: str
    check: Callable[[], Finding]
    where: str = ""
    printed: str = ""
    consequence: Consequence = "none"
    module: str = field(default_factory=module_being_imported, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        what = f"claim '{self.id}'"
        check_id("claim", self.id)
        check_texts(what, text=self.text, where=self.where, printed=self.printed)
        check_one_of(what, "consequence", self.consequence, get_args(Consequence))
        check_function(what, "its check", self.check)


@dataclass
class Claims:
    """All checkable sentences of a paper (or of one part of it).

    Attributes
    ----------
    id, title
        Name of the exhibit, and one line.
    kind
        Always ``claims``.
    claims
        By id.
    depends
        Files and folders, as for `Table`.
    module
        The module in which it is defined; set by itself.
    """

    id: str
    title: str
    kind: Literal["claims"] = "claims"
    claims: dict[str, Claim] = field(default_factory=dict)
    depends: tuple[str, ...] = ()
    module: str = field(default_factory=module_being_imported, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        check_id("exhibit", self.id)
        check_texts(self.id, title=self.title)

    def claim(
        self, id: str, text: str, *, where: str = "", printed: str = "", consequence: Consequence = "none"
    ) -> Callable[[Callable[[], Finding]], Callable[[], Finding]]:
        """Register the decorated function as the check of a claim.

        Parameters
        ----------
        id, text, where, printed, consequence
            As for `Claim`.

        Raises
        ------
        PaperDefinitionError
            If the id is taken.

        Examples
        --------
        >>> claims = Claims("claims", "Claims made in the text")
        >>> @claims.claim("smaller", "The second number is the smaller one.", where="section 2")
        ... def smaller() -> Finding:
        ...     return Finding("holds" if 2.0 < 3.0 else "fails", 2.0, "It is 2, the first 3.")
        >>> claims.claims["smaller"].check().verdict
        'holds'
        """

        def register(check: Callable[[], Finding]) -> Callable[[], Finding]:
            check_id("claim", id, self.claims)
            self.claims[id] = Claim(id, text, check, where, printed, consequence)
            return check

        return register
