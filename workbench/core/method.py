"""What every registered method has in common: a name, a citation, the kinds of map it serves, a form of parameters."""

from __future__ import annotations

from dataclasses import MISSING, dataclass, field, fields, is_dataclass
from typing import Any, ClassVar, Literal, get_args, get_origin, get_type_hints

from workbench.core.errors import WorkbenchError

Kind = Literal["plane", "parameterize", "volume"]
KINDS: tuple[Kind, ...] = ("plane", "parameterize", "volume")


@dataclass(frozen=True)
class Parameter:
    """One line of a form.

    `type` is float, int, bool or str; `choices` is not empty where only some values are allowed;
    `minimum` and `maximum` are inclusive.
    """

    name: str
    type: type
    default: Any
    description: str = ""
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()

    def check(self, value: Any) -> Any:
        """`value` converted to the parameter's type. Raises `WorkbenchError` where it does not fit."""
        try:
            if self.type is bool:
                converted: Any = _as_bool(value)
            elif self.type is int:
                converted = int(value)
                if float(value) != converted:
                    raise ValueError
            else:
                converted = self.type(value)
        except (TypeError, ValueError, OverflowError):
            raise WorkbenchError(f"{self.name} = {value!r} is not a value of type {self.type.__name__}.") from None
        if self.choices and converted not in self.choices:
            raise WorkbenchError(f"{self.name} = {value!r} is not one of {', '.join(self.choices)}.")
        if self.type in (int, float):
            low = self.minimum is not None and not converted >= self.minimum
            high = self.maximum is not None and not converted <= self.maximum
            if low or high or converted != converted:
                raise WorkbenchError(f"{self.name} = {value} is outside [{self.minimum}, {self.maximum}].")
        return converted


def parameter(
    default: Any,
    description: str,
    *,
    minimum: float | None = None,
    maximum: float | None = None,
) -> Any:
    """A dataclass field that is a parameter of a method, with what its form needs."""
    return field(default=default, metadata={"description": description, "minimum": minimum, "maximum": maximum})


class Method:
    """Base of solvers and initializers: subclasses are frozen dataclasses whose fields are their parameters."""

    id: ClassVar[str]
    label: ClassVar[str]
    citation: ClassVar[str] = ""
    kinds: ClassVar[tuple[Kind, ...]] = KINDS

    @classmethod
    def parameters(cls) -> tuple[Parameter, ...]:
        """The form of this method, read from the dataclass fields."""
        if not is_dataclass(cls):
            return ()
        hints = get_type_hints(cls)
        form = []
        for item in fields(cls):
            hint = hints[item.name]
            choices: tuple[str, ...] = tuple(get_args(hint)) if get_origin(hint) is Literal else ()
            default = item.default if item.default is not MISSING else None
            form.append(
                Parameter(
                    name=item.name,
                    type=str if choices else hint,
                    default=default,
                    choices=choices,
                    **{k: item.metadata.get(k) for k in ("minimum", "maximum")},
                    description=item.metadata.get("description", ""),
                )
            )
        return tuple(form)

    @classmethod
    def configured(cls, values: dict[str, Any] | None = None) -> Any:
        """An instance with `values`; names and ranges are checked. Raises `WorkbenchError`."""
        form = {p.name: p for p in cls.parameters()}
        chosen = {}
        for name, value in (values or {}).items():
            if name not in form:
                known = ", ".join(form) or "none"
                raise WorkbenchError(f"{cls.label} has no parameter {name!r}; it has: {known}.")
            chosen[name] = form[name].check(value)
        return cls(**chosen)


def _as_bool(value: Any) -> bool:
    if isinstance(value, str):
        lowered = value.strip().lower()
        if lowered in ("true", "yes", "on", "1"):
            return True
        if lowered in ("false", "no", "off", "0"):
            return False
        raise ValueError
    return bool(value)
