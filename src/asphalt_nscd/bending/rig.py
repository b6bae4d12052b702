"""The rig of a test: what stands between specimen and record that the reduction does not know."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.nscd.bonds.head import HeadDevices

KEYS = {
    "clamp_compliance": "clamp_compliance_m_N",
    "guide_stiffness": "guide_stiffness_N_m",
    "guide_friction": "guide_friction_N",
    "head_mass": "head_mass_kg",
    "channel_delay": "channel_delay_s",
    "phase_offset": "phase_offset_rad",
}
# a mass below zero: less moves than the reduction counts
SIGNED = ("channel_delay", "phase_offset", "head_mass")
LARGEST = 1e15  # in SI units: far beyond any rig, and squares are finite


@dataclass(frozen=True)
class Rig(HeadDevices):
    """Devices at the head and the measuring channel; all zero: the test as the reduction takes it.

    Delay and offset of the channel, of either sign, add to the phase: E_apparent = E exp(i (omega delay +
    offset)).

    Parameters
    ----------
    clamp_compliance : float
        Of the clamp between actuator, which is driven and measured, and head [m/N].
    guide_stiffness : float
        Of a spring between head and ground [N/m].
    guide_friction : float
        Of a Coulomb slider between head and ground [N].
    head_mass : float
        Moves with the head beside the mobile mass of the geometry [kg]; negative where that was taken too
        large, which a compliant clamp does not allow.
    channel_delay : float
        Of the displacement behind the force [s].
    phase_offset : float
        The same as a constant angle [rad].

    Raises
    ------
    InputError
        For a value that is too large or may not be negative.

    Examples
    --------
    >>> Rig(clamp_compliance=1e-8, channel_delay=0.8e-3).is_rigid, Rig(channel_delay=0.8e-3).is_rigid
    (False, True)
    """

    channel_delay: float = 0.0
    phase_offset: float = 0.0

    def __post_init__(self) -> None:
        for name in KEYS:
            value = getattr(self, name)
            allowed = Range(low=-LARGEST if name in SIGNED else 0.0, high=LARGEST)
            if not allowed.holds(value):
                raise InputError(f"rig: {KEYS[name]} = {value:g} must be {allowed}.")
        # behind a clamp the balance of the head (nscd/bonds/head.py) is monotone only with masses above zero
        if self.head_mass < 0.0 < self.clamp_compliance:
            raise InputError(
                f"rig: head_mass_kg = {self.head_mass:g} is negative, which a compliant clamp does not allow; give one "
                "of the two, or a smaller mobile mass."
            )

    @property
    def is_rigid(self) -> bool:
        """Whether the specimen's head is driven itself, with nothing beside it.

        Returns
        -------
        bool
            True without devices; errors of the channel do not count.
        """
        return not any(self.head_constants)

    def columns(self) -> dict[str, float]:
        """Values as files and tables name them.

        Returns
        -------
        dict of str to float
            By `KEYS`, which end in their units.
        """
        return {KEYS[name]: float(value) for name, value in asdict(self).items()}


def write_rig(path: str | Path, rig: Rig) -> None:
    """Write a rig as JSON, by KEYS, whose names end in units; `read_rig` reads it."""
    from asphalt_nscd.files.store import write_json

    write_json(path, rig.columns())


def read_rig(path: str | Path) -> Rig:
    """Read a rig from JSON with keys among `KEYS`; keys that are absent are zero."""
    from asphalt_nscd.files.store import read_json

    content = read_json(path)
    if not isinstance(content, dict):
        raise InputError(f"{path}: not a rig; give an object with keys among {', '.join(KEYS.values())}.")
    names = {key: name for name, key in KEYS.items()}
    for key, value in content.items():
        if key not in names:
            raise InputError(f"{path}: key {key!r} is not known; give keys among {', '.join(names)}.")
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise InputError(f"{path}: key {key!r} is {value!r}; give a number.")
    try:
        return Rig(**{names[key]: float(value) for key, value in content.items()})
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
