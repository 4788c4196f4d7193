from os import PathLike
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import NDArray

Path = Union[str, PathLike[str]]
# called with the name of the step, what is done and what there is in all
Progress = Callable[[str, int, int], object]

__version__: str
__all__: List[str]

class Error(Exception):
    """What fails while running, with the text that `lumulus` would print."""

class InputError(Error):
    """Bad input: what is wrong (file or key): how to mend it."""

class Scene:
    """A scene: a file or text, the keys that were set since, densities from arrays."""

    def __init__(self, path: Path, quality: Optional[str] = None, frame: float = 0.0) -> None:
        """A scene file, or an OpenVDB or NanoVDB file. `quality`: draft, interactive or final."""
    @staticmethod
    def from_text(text: str, name: str = "text", quality: Optional[str] = None, frame: float = 0.0) -> Scene:
        """A scene from TOML. `name` stands for the file in messages; relative paths start in its folder."""
    def set(self, key: str, value: Any) -> None:
        """Sets a key, as `--set key=value`: number, text, bool, list or dict."""
    def update(self, values: Mapping[str, Any]) -> None:
        """Sets several keys, all or none of them."""
    def set_density(
        self,
        array: NDArray[numpy.floating[Any]],
        voxel_size: Union[float, Sequence[float]],
        origin: Sequence[float] = (0.0, 0.0, 0.0),
        cloud: Union[int, str] = 0,
    ) -> None:
        """Densities in place of a cloud's file. array[i, j, k] sits at origin + (i, j, k) * voxel_size [m]: x, y (up), z."""
    @property
    def source(self) -> str: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def seed(self) -> int: ...

class Picture:
    """Arrays by layer, float32, height x width x channels, rows from the top."""

    def __init__(self, arrays: Mapping[str, NDArray[numpy.floating[Any]]]) -> None: ...
    @staticmethod
    def read(path: Path) -> Picture:
        """A picture from an EXR file."""
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def attributes(self) -> Dict[str, str]:
        """What the header of its EXR file says: scene, seed, device, samples."""
    @property
    def rgb(self) -> NDArray[numpy.float32]:
        """The layer "RGB"."""
    def channels(self, layer: str) -> List[str]:
        """Names of the channels of a layer, in the order of the last axis."""
    def write(self, path: Path) -> None:
        """Writes .exr (all layers) or .png (tone mapped)."""
    def keys(self) -> List[str]: ...
    def __getitem__(self, layer: str) -> NDArray[numpy.float32]: ...
    def __contains__(self, layer: str) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...

class Renderer:
    """A scene on a device, prepared to be rendered. Its views share the photons."""

    def __init__(self, scene: Scene, device: str = "", progress: Optional[Progress] = None) -> None: ...
    def trace(self, generations: Optional[int] = None, progress: Optional[Progress] = None) -> int:
        """Traces photons: all that the scene asks for, or some generations. Returns how many are missing."""
    def render(
        self,
        position: Optional[Tuple[float, float, float]] = None,
        target: Optional[Tuple[float, float, float]] = None,
        progress: Optional[Progress] = None,
    ) -> Picture:
        """Traces what is missing and draws a picture, from the scene's camera or another place [m]."""
    def statistics(self) -> Dict[str, Any]: ...

def render(scene: Scene, device: str = "", progress: Optional[Progress] = None) -> Picture:
    """The picture that `lumulus render` makes, to the bit."""

def reference(
    scene: Scene,
    *,
    spp: Optional[int] = None,
    seconds: Optional[float] = None,
    majorant: str = "global",
    progress: Optional[Progress] = None,
) -> Picture:
    """The picture that `lumulus reference` makes: path traced on the CPU, without bias, slow."""

def compare(image: Union[Picture, Path], reference: Union[Picture, Path], exposure: float = 0.0) -> Dict[str, Any]:
    """What `lumulus compare --json` tells: rmse, relmse, bias, mape, flip and their standard errors."""

def limit_threads(threads: int) -> None:
    """Bounds the threads of this process, before its first Renderer, until it ends."""
