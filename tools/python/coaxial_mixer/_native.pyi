from typing import Any

import numpy as np
import numpy.typing as npt

Rows = tuple[npt.NDArray[Any], npt.NDArray[Any] | None, npt.NDArray[Any] | None, list[int]]
Texts = tuple[str, str, str, str, list[str]]

class MixerError(ValueError):
    """What is wrong with an input, with its place and the mend."""

class Native:
    name: str
    channels: list[tuple[int, ...]]
    verdict: str
    warnings: list[str]
    rust: str
    json: str
    def __init__(self, name: str, text: bytes) -> None: ...
    def mix(self, rows: Rows) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], npt.NDArray[np.uint16]]: ...
    def mix_dynamic(self, rows: Rows) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], npt.NDArray[np.uint16]]: ...
    def conventional(self, rows: Rows) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]: ...
    def wrench(self, rows: Rows) -> npt.NDArray[np.float64]: ...
    def efforts(self, rows: Rows) -> npt.NDArray[np.float64]: ...

def identify(words: list[str]) -> Texts: ...
def predict(words: list[str]) -> Texts: ...
