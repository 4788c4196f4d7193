"""Cameras and suns that are in no shipped scene, which a renderer could have been tuned to: name → scene, overrides."""

# The cumulus as cumulus-side-lit frames it: the camera looks towards azimuth 340, 7° upwards.
_BESIDE = ["camera.position=[430,150,1180]", "camera.target=[0,300,0]", "camera.vertical_fov=32"]


def _camera(position, target, vertical_fov):
    return [f"camera.position={position}", f"camera.target={target}", f"camera.vertical_fov={vertical_fov}"]


def _sun(azimuth, elevation):
    return [f"sun.azimuth={azimuth}", f"sun.elevation={elevation}"]


VIEWS = {
    "cumulus-side-15": ("cumulus", _BESIDE + _sun(70, 15)),
    "cumulus-side-45": ("cumulus", _BESIDE + _sun(70, 45)),
    "cumulus-front-15": ("cumulus", _BESIDE + _sun(160, 15)),
    "cumulus-front-45": ("cumulus", _BESIDE + _sun(160, 45)),
    "cumulus-back-15": ("cumulus", _BESIDE + _sun(340, 15)),
    "cumulus-back-45": ("cumulus", _BESIDE + _sun(340, 45)),
    "cumulus-zenith": ("cumulus", _BESIDE + _sun(70, 80)),
    "cumulus-into-sun": ("cumulus", _BESIDE + _sun(340, 7)),
    "cumulus-from-below": ("cumulus", _camera([100, -500, 250], [0, 300, 0], 60) + _sun(70, 35)),
    "cumulus-from-above": ("cumulus", _camera([300, 1500, 500], [0, 300, 0], 40) + _sun(70, 35)),
    "cumulus-telephoto": ("cumulus", _camera([3440, 400, 9440], [0, 300, 0], 3) + _sun(70, 35)),
    "cumulus-near": ("cumulus", _camera([150, 300, 560], [0, 330, 0], 50) + _sun(70, 35)),
    "disney-back-lit": ("disney-cloud", _sun(307, 15)),
    "disney-front-lit": ("disney-cloud", _sun(127, 30)),
    "smoke-back-lit": ("smoke", _sun(340, 20)),
    "stratus-from-below": ("stratus", _camera([200, -250, 500], [0, 80, 0], 60) + _sun(310, 40)),
    "stratus-low-sun": ("stratus", _sun(310, 3)),
}
