"""Arrays that lie in the memory of a GPU."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .errors import InputError

if TYPE_CHECKING:
    from ._treacle import Session


class DeviceArray:
    """A field of the fluid in the memory of the GPU, without a copy.

    PyTorch, CuPy and others take it by DLPack (`torch.from_dlpack(x)`, `cupy.from_dlpack(x)`) or by
    `__cuda_array_interface__` (`cupy.asarray(x)`, `torch.as_tensor(x, device="cuda")`); `numpy.asarray(x)` and `get()`
    copy it to the host.

    It holds until the next step: from then on it refuses with RuntimeError. What another library has taken of it before
    cannot refuse: its memory then holds other particles, or nothing.
    It is to be read only; assign to the attribute of `sim.fluid` to change the fluid.
    """

    def __init__(self, session: Session, name: str) -> None:
        self._session, self._name, self._version = session, name, session.version

    def _check(self) -> None:
        if self._session.version != self._version:
            raise RuntimeError(
                f"the array of {self._name} is out of date: a step was made since it was asked for; expected "
                f"sim.fluid.{self._name} to be asked for anew"
            )

    @property
    def shape(self) -> tuple[int, ...]:
        self._check()
        return self._session.field_address(self._name)[1]

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype(self._session.field_address(self._name)[2])

    @property
    def ndim(self) -> int:
        return len(self.shape)

    def __len__(self) -> int:
        return self.shape[0]

    def __repr__(self) -> str:
        return f"DeviceArray({self._name}, shape={self.shape}, dtype={self.dtype})"

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        self._check()
        address, shape, kind = self._session.field_address(self._name)
        if not self._session.on_device:
            raise AttributeError("__cuda_array_interface__: the CPU computes")
        return {
            "shape": shape,
            "typestr": kind,
            "data": (address, False),
            "version": 3,
            "strides": None,
            "stream": None,
        }

    def __dlpack__(self, **options: Any) -> Any:
        """The data are there for all streams. Errors: BufferError where a copy is asked for, which get() makes."""
        self._check()
        if options.get("copy"):
            raise BufferError("expected no copy, or that of get(): these are the simulation's own data")
        return self._session.field_in_place(self._name).__dlpack__()

    def __dlpack_device__(self) -> tuple[int, int]:
        self._check()
        device: tuple[int, int] = self._session.field_in_place(self._name).__dlpack_device__()
        return device

    def get(self) -> NDArray[Any]:
        """A copy on the host."""
        self._check()
        copied: NDArray[Any] = self._session.copied_field(self._name)
        return copied

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False:
            raise ValueError("the array lies in the memory of the GPU: NumPy needs a copy")
        values = self.get()
        return values if dtype is None else values.astype(dtype, copy=False)


def given_array(value: Any, what: str) -> Any:
    """What was given, as an array of doubles where it lies: on the GPU as it is, otherwise one of NumPy's."""
    if value is None:
        return None
    device = getattr(value, "__dlpack_device__", None)
    if device is not None and device()[0] == 2:  # CUDA, by the standard of DLPack
        if str(value.dtype).rsplit(".")[-1] != "float64":
            raise InputError(f"{what}: expected 64 bit numbers, found {value.dtype}")
        return value
    try:
        return np.asarray(value, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise InputError(f"{what}: expected an array of numbers: {error}") from None
