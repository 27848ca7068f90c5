"""Between what the window holds and what a session, or a step of the history, keeps of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Any

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.history import Curves
from workbench.core.arrays import Floats
from workbench.session.session import ANCHORS, Session


@dataclass(frozen=True, eq=False)
class Wanted:
    """A state to go to once its mesh is open: choices with anchors, a map (or the start), and whether the solver runs.

    `curves` are those that led to the map, where they are known.
    """

    session: Session
    positions: Floats | None
    runs: bool = False
    curves: Curves | None = None


def with_anchors(session: Session, anchors: AnchorSet) -> Session:
    """The choices together with these anchors."""
    return replace(
        session,
        anchor_vertices=tuple(anchors.targets),
        anchor_targets=tuple(anchors.targets.values()),
        anchor_weights=tuple(anchors.weight_array.tolist()),
        anchor_groups=tuple(anchors.group_numbers.tolist()),
        anchors_off=anchors.off,
    )


def without_anchors(session: Session) -> Session:
    """The choices alone."""
    nothing: dict[str, Any] = dict.fromkeys(ANCHORS, ())
    return replace(session, **nothing, anchors_off=frozenset())


def anchors_in(session: Session) -> AnchorSet:
    """The anchors of a session as the window holds them."""
    vertices = session.anchor_vertices
    groups = zip(vertices, session.anchor_groups or (-1,) * len(vertices), strict=True)
    weights = zip(vertices, session.anchor_weights or (inf,) * len(vertices), strict=True)
    return AnchorSet(
        dict(zip(vertices, session.anchor_targets, strict=True)),
        {vertex: group for vertex, group in groups if group >= 0},
        {vertex: weight for vertex, weight in weights if weight < inf},
        session.anchors_off,
    )


def suits(session: Session, positions: Floats) -> bool:
    """Whether the anchors of a session are those of a mesh whose maps are (n, d) as `positions`."""
    count, dimension = positions.shape
    vertices = max((*session.anchor_vertices, *session.anchors_off), default=0)
    return vertices < count and all(len(target) == dimension for target in session.anchor_targets)


def drawn_parameters(session: Session, changes: Mapping[str, Any]) -> str:
    """Names of the parameters that change while their method stays, as by a slider; empty for any other change."""
    names = sorted(name for name in changes if name.endswith("_parameters"))
    methods = [name for name in changes if name not in names]
    return ",".join(names) if all(changes[name] == getattr(session, name) for name in methods) else ""


def is_on_same_source(one: Session, other: Session) -> bool:
    """Whether both are about one mesh, read and mended alike."""
    return (one.source, one.kind, one.fixes) == (other.source, other.kind, other.fixes)


def name_of_anchor_change(before: AnchorSet, after: AnchorSet) -> str:
    """What a step is called that leads from one set of anchors to another."""
    added, removed = len(set(after.targets) - set(before.targets)), len(set(before.targets) - set(after.targets))
    moved = sum(before.targets[v] != target for v, target in after.targets.items() if v in before.targets)
    if moved and moved >= added and not removed:  # those that were set for it, as a mirror twin, moved along
        verb, count = "Move", moved + added
    elif added or removed:
        verb, count = ("Set", added) if added >= removed else ("Remove", removed)
    elif before.off != after.off:
        gone, back = len(after.off - before.off), len(before.off - after.off)
        verb, count = ("Switch off", gone) if gone >= back else ("Switch on", back)
    elif before.weights != after.weights:
        changed = [v for v in after.targets if before.weights.get(v) != after.weights.get(v)]
        verb, count = ("Weight of" if any(v in after.weights for v in changed) else "Harden"), len(changed)
    else:
        return "Group anchors"
    return f"{verb} anchor" if count == 1 else f"{verb} {count} anchors"
