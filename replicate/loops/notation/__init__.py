"""Plants and controllers as text: one parser, and its exact inverse."""

from replicate.loops.notation.controllers import controller_notation, parse_controller
from replicate.loops.notation.plants import parse_plant, plant_notation

__all__ = ["controller_notation", "parse_controller", "parse_plant", "plant_notation"]
