"""Which scenes a map, a ring or a chart of cost is for, and why it leaves others out."""

from engine.scenes import Scene
from tui.words.findings import short_name


def left_out(scene: Scene, what: str) -> str:
    """Why a scene that is not general has no such picture; "" if it has one."""
    if scene.general:
        return ""
    return f"{what} is for methods that take any force, on a pendulum without friction."


def has_ring(scene: Scene) -> bool:
    """Whether all of the cast can carry a ring of neighbouring starts: with friction, too."""
    return scene.general or scene.model == "damped"


def ring_left_out(scene: Scene) -> str:
    """Why there is no ring; "" if there may be one."""
    if scene.model == "spring":
        return "Angle and angular velocity of the swing: a projection of four dimensions, without curves or ring."
    if has_ring(scene):
        return ""
    return f"No ring with {', '.join(short_name(each) for each in scene.cast if not each.general)} in the cast."
