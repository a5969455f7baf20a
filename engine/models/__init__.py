"""The models, one a file, and the exact motion that methods are compared with."""

from pendu_tui.engine.models.damped import DampedPendulum
from pendu_tui.engine.models.mean_field import MeanField
from pendu_tui.engine.models.model import COMMON as COMMON
from pendu_tui.engine.models.model import Model as Model
from pendu_tui.engine.models.model import Number
from pendu_tui.engine.models.pendulum import LinearOscillator as LinearOscillator
from pendu_tui.engine.models.pendulum import Pendulum as Pendulum
from pendu_tui.engine.models.spring import Spring

MODELS: dict[str, type[Model]] = {
    model.key: model for model in (Pendulum, LinearOscillator, DampedPendulum, Spring, MeanField)
}

DEFAULT_MODEL = Pendulum.key

STUDIED = tuple(key for key, model in MODELS.items() if not model.without_force)
"""The models that maps and studies apply to; every general method integrates them."""

NUMBERS: dict[str, Number] = {
    each.name: each
    for each in (*COMMON, *(own for model in MODELS.values() for own in model.parameters))
}
"""The numbers of all scenes, by name: those that every scene has, then the models' own."""
