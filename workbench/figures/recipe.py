"""What a figure shows: a page, maps, and the panels that are made of them. Plain values; nothing is read or drawn here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from workbench.core.solid_look.look import VolumeLook
from workbench.session.session import Session

CHEQUERED = "chequered"
PICTURE = "picture"
PLAIN = "plain"
TEXTURES = (CHEQUERED, "grid", "circles", "stripes")
"""Textures of two colours."""
PATTERNS = (*TEXTURES, PICTURE, PLAIN)
"""Colourings that are no measure: textures that are even in the map or in the source, a picture, and one colour."""
PLACES = ("map", "source")
"""What a texture is laid out in."""
KINDS = ("map", "source", "histogram", "curves", "colour-bar", "empty")
BACKGROUNDS = ("white", "transparent")
QUANTITIES = {"energy": "energy", "gradient-norm": "gradient norm", "inverted": "inverted"}
"""What curves show over the iterations, with the words of their axis."""
NO_GLYPHS = "none"
GLYPHS = (NO_GLYPHS, "stretches", "ellipses")
DEFAULT_MEASURE = "symmetric-dirichlet"


@dataclass(frozen=True)
class Page:
    """The paper: `width` in mm, `dpi` of PNG and of pictures inside PDF and SVG, `font_size` in points."""

    width: float = 180.0
    dpi: int = 300
    font_size: float = 8.0
    background: str = "white"
    columns: int = 3
    letters: bool = False
    title: str = ""


@dataclass(frozen=True)
class MapChoice:
    """A map: out of the file `target`, or what `session` leads to from its start.

    `history` is a table of the steps that led to a map in a file, for curves. `session.iterations` is where the solver is
    stopped; curves and captions call the map by its `label`.
    """

    name: str
    session: Session
    target: str = ""
    history: str = ""
    label: str = ""

    @property
    def title(self) -> str:
        return self.label or self.name


@dataclass(frozen=True)
class SolidLook:
    """How a panel looks into a solid.

    `shape` says what is left of it;  `peel_by` is the measure of its threshold, with `parameters`;  `marked` are the
    tetrahedra that are drawn where only those are
    """

    shape: VolumeLook = field(default_factory=VolumeLook)
    peel_by: str = DEFAULT_MEASURE
    parameters: Mapping[str, float] = field(default_factory=dict)
    marked: tuple[int, ...] = ()


@dataclass(frozen=True)
class CarriedLook:
    """How a panel shows the surface that a solid carries: the measure of its own map with `parameters`, the `range` of its
    colours and whether they are `logarithmic` (None: fitted), the `opacity` of the solid round it."""

    colour: str = DEFAULT_MEASURE
    parameters: Mapping[str, float] = field(default_factory=dict)
    range: tuple[float, float] | None = None
    logarithmic: bool | None = None
    opacity: float = 0.25


@dataclass(frozen=True)
class TextureLook:
    """How a texture lies: a point x of the map, or of the source, is at matrix x + offset of it.

    There a field of a board or a stripe has the side 1, as has the cell of a grid or of circles, and a picture goes from 0
    to 1, its first row at the top, and is repeated. `of` is one of `PLACES`;  `matrix` has a row for each coordinate of the
    texture, of which all but a picture have as many as what they are laid out in;  `picture` is a PNG or JPEG.
    """

    of: str = PLACES[0]
    matrix: tuple[tuple[float, ...], ...] = ((1.0, 0.0), (0.0, 1.0))
    offset: tuple[float, ...] = (0.0, 0.0)
    picture: str = ""


@dataclass(frozen=True)
class Panel:
    """A part of the page.

    Parameters
    ----------
    kind : str            one of `KINDS`
    maps : tuple of str   names of maps: one of them for `map` and `source`
    colour : str          a measure (see `workbench.core.measure`), or one of `PATTERNS`
    parameters : dict     of the measure
    scale : str           panels of one name share one range of colours, or of bins
    range : (low, high)   of the colours; None: fitted
    logarithmic : bool    whether the colours are; None: where they span much
    reversed : bool       whether the colours run the other way, for all panels of one scale
    clipped : bool        whether what lies beyond the range has colours of its own
    frame : str           maps of one name are drawn on one scale of length
    view : axes           three rows: to the right, up, to the viewer, of what lies in space; empty: where it shows itself well
    bar : bool            a colour bar below
    caption : str         above; empty for the label of the map, where there is one
    edges, anchors : bool     whether they are drawn
    wires : bool          nothing but the sides of triangles, in their colours
    seams, boundary : bool    lines where the texture of the file jumps, and round a surface
    scale_bar : bool      a round length in the lower right corner
    texture : TextureLook     how a texture lies; None: fitted to the map
    glyphs : str          one of `GLYPHS`: lines along principal stretches, or images of circles; `glyph_count` at the most,
                          `glyph_size` times as large as usual
    look : SolidLook      how a solid is looked into; None: from outside
    carried : CarriedLook     how the surface is shown that the solid carries; None: not at all
    quantity : str        of curves, one of `QUANTITIES`
    bins : int            of a histogram
    span : int            columns that it takes
    """

    kind: str = "map"
    maps: tuple[str, ...] = ()
    colour: str = DEFAULT_MEASURE
    parameters: Mapping[str, float] = field(default_factory=dict)
    scale: str = ""
    range: tuple[float, float] | None = None
    logarithmic: bool | None = None
    reversed: bool = False
    clipped: bool = False
    frame: str = ""
    view: tuple[tuple[float, ...], ...] = ()
    bar: bool = False
    caption: str = ""
    edges: bool = False
    anchors: bool = True
    wires: bool = False
    seams: bool = False
    boundary: bool = False
    scale_bar: bool = False
    texture: TextureLook | None = None
    glyphs: str = NO_GLYPHS
    glyph_count: int = 300
    glyph_size: float = 1.0
    look: SolidLook | None = None
    carried: CarriedLook | None = None
    quantity: str = "energy"
    bins: int = 48
    span: int = 1

    @property
    def is_picture(self) -> bool:
        """Whether it shows a mesh."""
        return self.kind in ("map", "source")

    @property
    def is_textured(self) -> bool:
        return self.colour in TEXTURES or self.colour == PICTURE

    @property
    def has_measure(self) -> bool:
        return self.kind != "empty" and self.colour not in PATTERNS


@dataclass(frozen=True)
class Recipe:
    """A figure that can be made again."""

    page: Page
    maps: tuple[MapChoice, ...]
    panels: tuple[Panel, ...]
