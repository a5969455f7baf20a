"""Scenes: what determines a run, and those worth watching."""

from engine.scenes.listed import DEFAULT_SCENE as DEFAULT_SCENE
from engine.scenes.listed import GROUPS as GROUPS
from engine.scenes.listed import SCENES as SCENES
from engine.scenes.scene import LIMITS as LIMITS
from engine.scenes.scene import MAX_METHODS as MAX_METHODS
from engine.scenes.scene import QUANTITIES as QUANTITIES
from engine.scenes.scene import UNITS as UNITS
from engine.scenes.scene import Z_LIMITS as Z_LIMITS
from engine.scenes.scene import Line as Line
from engine.scenes.scene import Scene as Scene
from engine.scenes.scene import SceneError as SceneError
from engine.scenes.scene import Shot as Shot
from engine.scenes.scene import check_h as check_h
