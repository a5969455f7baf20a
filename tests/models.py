"""The models as tests see them: each with the parameters of its first scene."""

from pendu_tui.engine.models import Model
from pendu_tui.engine.scenes import SCENES, Scene

EXAMPLES: dict[str, Scene] = {}
for scene in SCENES.values():
    EXAMPLES.setdefault(scene.model, scene)

EQUATIONS: list[Model] = [scene.equations for scene in EXAMPLES.values()]
