"""Images that stay on a CUDA device, as DLPack hands them on: behind the stand-in for CUDA's driver, which keeps
the memory of its two devices in that of the processor. CTest names it to the loader in LD_LIBRARY_PATH."""

import contextlib
import ctypes
import gc
import weakref

import numpy as np
import pytest

from galactic import Renderer, Simulator

ENVS = 3
CAMERA = {"camera": "follow", "width": 24, "height": 16, "semantics": True}
CUDA = 2


class Tensor(ctypes.Structure):
    """DLManagedTensor, as dlpack.h has it."""

    _fields_ = [
        ("data", ctypes.c_void_p),
        ("device_type", ctypes.c_int32),
        ("device_id", ctypes.c_int32),
        ("axes", ctypes.c_int32),
        ("code", ctypes.c_uint8),
        ("bits", ctypes.c_uint8),
        ("lanes", ctypes.c_uint16),
        ("shape", ctypes.POINTER(ctypes.c_int64)),
        ("strides", ctypes.POINTER(ctypes.c_int64)),
        ("byte_offset", ctypes.c_uint64),
        ("context", ctypes.c_void_p),
        ("deleter", ctypes.CFUNCTYPE(None, ctypes.c_void_p)),
    ]


_pointer_in = ctypes.pythonapi.PyCapsule_GetPointer
_pointer_in.restype, _pointer_in.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
_rename = ctypes.pythonapi.PyCapsule_SetName
_rename.argtypes = [ctypes.py_object, ctypes.c_char_p]
USED = b"used_dltensor"


@contextlib.contextmanager
def taken(images, stream=None):
    """The tensor of a DeviceArray, as long as a consumer has it."""
    capsule = images.__dlpack__(stream=stream)
    address = _pointer_in(capsule, b"dltensor")
    _rename(capsule, USED)
    tensor = Tensor.from_address(address)
    yield tensor
    tensor.deleter(address)


def array_of(images):
    """What lies on the stand-in's device."""
    with taken(images) as tensor:
        shape = tuple(tensor.shape[: tensor.axes])
        kind = np.dtype(f"{'iuf'[tensor.code]}{tensor.bits // 8}")
        assert (tensor.lanes, tensor.byte_offset, bool(tensor.strides)) == (1, 0, False)
        bytes_there = ctypes.string_at(tensor.data, int(np.prod(shape)) * kind.itemsize)
    return np.frombuffer(bytes_there, kind).reshape(shape)


@pytest.fixture(scope="module")
def driver():
    try:
        library = ctypes.CDLL("libcuda.so.1")
        library.galactic_standin  # noqa: B018
    except (OSError, AttributeError):
        pytest.skip("the stand-in for CUDA's driver is not what the loader finds")
    library.cuInit(0)
    return library


@pytest.fixture
def simulator(world):
    return Simulator(world, envs=ENVS, threads=1, body_transforms=True)


@contextlib.contextmanager
def current(driver, device):
    """A context of a device is this thread's current one, as torch.cuda.set_device() has it."""
    context = ctypes.c_void_p()
    assert driver.cuDevicePrimaryCtxRetain(ctypes.byref(context), device) == 0
    assert driver.cuCtxPushCurrent_v2(context) == 0
    yield
    driver.cuCtxPopCurrent_v2(ctypes.byref(context))
    driver.cuDevicePrimaryCtxRelease_v2(device)


def test_images_on_the_device_are_those_that_are_read_back(driver, simulator):
    renderer = Renderer(simulator, **CAMERA, backend="cuda")
    wanted = renderer.render()
    found = renderer.render_to_device()
    assert {name: one.shape for name, one in found.items()} == {
        name: one.shape for name, one in wanted.items()
    }
    for name, images in found.items():
        np.testing.assert_array_equal(array_of(images), wanted[name])
        assert array_of(images).dtype == wanted[name].dtype


@pytest.mark.parametrize("device", [0, 1])
@pytest.mark.parametrize("else_current", [None, 0, 1])
def test_images_are_on_the_device_of_their_renderer(driver, simulator, device, else_current):
    renderer = Renderer(simulator, **CAMERA, backend="cuda", device=device)
    with contextlib.nullcontext() if else_current is None else current(driver, else_current):
        for images in renderer.render_to_device().values():
            assert images.__dlpack_device__() == (CUDA, device)
            # Of another device and stream, too: what is there is complete.
            for stream in (None, 1, 2, -1, 0x5A):
                with taken(images, stream) as tensor:
                    assert (tensor.device_type, tensor.device_id) == (CUDA, device)
            assert images.__dlpack__(dl_device=(CUDA, device)) is not None
            for wish in ({"dl_device": (CUDA, 1 - device)}, {"copy": True}, {"stream": 0}):
                with pytest.raises(BufferError):
                    images.__dlpack__(**wish)


def test_a_renderer_stays_while_anybody_uses_its_images(driver, simulator):
    renderer = Renderer(simulator, **CAMERA, backend="cuda")
    is_there = weakref.finalize(renderer, lambda: None)
    with taken(renderer.render_to_device()["depth"]):
        del renderer
        gc.collect()
        assert is_there.alive
    gc.collect()
    assert not is_there.alive


def test_a_capsule_that_nobody_takes_lets_go(driver, simulator):
    renderer = Renderer(simulator, **CAMERA, backend="cuda")
    is_there = weakref.finalize(renderer, lambda: None)
    capsule = renderer.render_to_device()["depth"].__dlpack__()
    del renderer
    gc.collect()
    assert is_there.alive
    del capsule
    gc.collect()
    assert not is_there.alive
