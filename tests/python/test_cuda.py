"""Views, stream order and writes on a CUDA device, by the driver alone: no package of Python is needed but numpy. Run it by itself:
WADI_LIBRARY=build/release/lib/libwadi.so PYTHONPATH=plugin/python python3 -m pytest -rs tests/python/test_cuda.py
Without a device, or with a library without CUDA, it is skipped and says so; WADI_REQUIRE_CUDA=1 makes that a failure."""
import ctypes
import os
from ctypes import byref, c_size_t, c_uint, c_uint64, c_void_p

import numpy as np
import pytest
import wadi
from wadi import cuda

_has = any(device.backend == "cuda" for device in wadi.devices()[0])
if not _has and os.environ.get("WADI_REQUIRE_CUDA") == "1":
    raise RuntimeError("WADI_REQUIRE_CUDA=1, and there is no CUDA device in wadi.devices(): " + wadi.devices()[1])
pytestmark = pytest.mark.skipif(not _has, reason="NO CUDA DEVICE: nothing of CUDA is tested here")

WATER = np.zeros((96, 128), "f4")
WATER[:, :40] = 1


def call(name, *given):
    status = getattr(cuda.driver(), name)(*given)
    assert status == 0, f"{name}: {status}"


@pytest.fixture
def world():
    with wadi.World(water=WATER, dx=0.5, dt=0.02, backend="cuda", log=False) as made:
        yield made


@pytest.fixture
def context():
    with cuda._Context(0) as held:
        yield held


def to_host(address, array):
    call("cuMemcpyDtoH_v2", c_void_p(array.ctypes.data), c_uint64(address), c_size_t(array.nbytes))
    return array


class DeviceArray:
    """Floats on the device, as CuPy has them."""

    def __init__(self, values, stream=None):
        self.address = c_uint64()
        call("cuMemAlloc_v2", byref(self.address), c_size_t(values.nbytes))
        call("cuMemcpyHtoD_v2", self.address, c_void_p(values.ctypes.data), c_size_t(values.nbytes))
        self.__cuda_array_interface__ = {"shape": values.shape, "typestr": "<f4", "data": (self.address.value, False), "version": 3,
                                         "strides": None, "stream": stream}

    def free(self):
        call("cuMemFree_v2", self.address)


def test_bits_and_views(world, context):
    world.set_outputs("free_surface", "flow")
    world.step(20)
    world.publish()
    for name in ("free_surface", "flow"):
        view = world.view(name)
        given = view.__cuda_array_interface__
        assert given["shape"] == view.shape and given["stream"] == 1 and given["data"] == (view.address, True)
        rows = np.zeros((view.shape[0], view.strides[0]), "u1")
        copied = to_host(view.address, rows[:-1])
        width = view.shape[1] * view.strides[1]
        last = to_host(view.address + rows[:-1].nbytes, np.zeros(width, "u1"))
        values = np.vstack([copied[:, :width], last[None]]).view("f4").reshape(view.shape)
        if name == "free_surface":
            assert np.array_equal(values, world.read("free_surface"))
        assert values.any()
        assert view.__dlpack_device__() == (2, 0)
        for stream in (None, 1, 2, -1):
            view.__dlpack__(stream=stream)
        with pytest.raises(TypeError, match="host=True"):
            np.asarray(view)
    cuda.wait(world)
    found = world.hash()
    with wadi.World(water=WATER, dx=0.5, dt=0.02, backend="cpu", log=False) as other:
        other.step(20)
        assert other.hash() == found


def test_streams_are_ordered(world, context):
    """A stream of ours copies a view while the world is asked for more; every copy has what the view's step had."""
    world.set_outputs("water_depth")
    stream = c_void_p()
    call("cuStreamCreate", byref(stream), c_uint(1))  # CU_STREAM_NON_BLOCKING: nothing orders it but events
    shown, expected = [], []
    with wadi.World(water=WATER, dx=0.5, dt=0.02, backend="cpu", log=False) as twin:
        for _ in range(30):
            world.step(50)
            world.update(0)
            view = world.view("water_depth")
            cuda.signal(world, stream.value)
            room = c_uint64()
            nbytes = view.strides[0] * (view.shape[0] - 1) + view.shape[1] * 4
            call("cuMemAlloc_v2", byref(room), c_size_t(nbytes))
            call("cuMemcpyDtoDAsync_v2", room, c_uint64(view.address), c_size_t(nbytes), stream)
            cuda.wait(world, stream.value)
            shown.append((room, view.strides[0], nbytes))
            del view
            twin.step(50)
            expected.append(twin.read("water_depth"))
    call("cuStreamSynchronize", stream)
    for (room, pitch, nbytes), depth in zip(shown, expected):
        data = np.zeros(pitch * depth.shape[0], "u1")
        to_host(room.value, data[:nbytes])
        assert np.array_equal(data.reshape(depth.shape[0], pitch)[:, :depth.shape[1] * 4].copy().view("f4"), depth)
        call("cuMemFree_v2", room)
    call("cuStreamDestroy_v2", stream)


def test_writes_from_the_device(world, context):
    values = np.linspace(0, 2, WATER.size, dtype="f4").reshape(WATER.shape)
    with wadi.World(water=WATER, dx=0.5, dt=0.02, backend="cpu", log=False) as other:
        for stream in (None, 1, 2):
            array = DeviceArray(values, stream)
            world.write("total_water_depth", array)
            other.write("total_water_depth", values)
            world.step(5)
            other.step(5)
            assert world.hash() == other.hash()
            array.free()
    small = DeviceArray(values[:2].copy())
    with pytest.raises(ValueError, match="values: their shape"):
        world.write("total_water_depth", small)
    small.free()
