"""Lumulus renders clouds, fog and air: scenes from files, text and NumPy arrays, pictures as arrays.

    import lumulus
    scene = lumulus.Scene("cumulus.toml")
    scene.set("sun.elevation", 20)
    picture = lumulus.render(scene)
    picture["RGB"]                    # float32, height x width x 3, linear

docs/python.md of Lumulus explains it.
"""
from ._core import (Error, InputError, Picture, Renderer, Scene, __version__, compare, limit_threads, reference,
                    render)

__all__ = ["Error", "InputError", "Picture", "Renderer", "Scene", "compare", "limit_threads", "reference", "render"]

for _thing in (Error, InputError, Picture, Renderer, Scene, compare, limit_threads, reference, render):
    try:
        _thing.__module__ = "lumulus"
    except AttributeError:  # functions of C++ keep theirs
        pass
del _thing
