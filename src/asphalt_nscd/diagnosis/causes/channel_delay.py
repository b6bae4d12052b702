import numpy as np

from asphalt_nscd.diagnosis.causes._cause import CHANNEL, Cause, Parameter


class ChannelDelay(Cause):
    """The displacement is recorded later than the force by a fixed time: F/z exp(i omega tau)."""

    name = "channel_delay"
    stage = CHANNEL
    parameters = (Parameter("delay", "s", -5e-3, 5e-3, 1e-4),)
    sentence = "the displacement channel lags the force channel by a fixed time"
    confirmed_by = (
        "a test on an elastic reference specimen of metal: its phase must be zero at every frequency"
    )

    def places(self, observed):
        return (None,) if observed.frequencies.size > 1 else ()

    def apparent(self, modulus, values, observed):
        inertia = observed.inertia * observed.omega**2
        return (modulus - inertia) * np.exp(1j * observed.omega * values[0]) + inertia

    def rig(self, values, form_factor, amplitude):
        return {"channel_delay_s": values[0]}
