"""Outputs without a copy: addresses, lifetimes, DLPack."""
import ctypes
import gc

import numpy as np
import pytest
import wadi
from wadi import _native, output
from wadi._library import native


@pytest.fixture
def world():
    water = np.zeros((32, 64))
    water[:, :20] = 1
    with wadi.World(water=water, dx=0.5, dt=0.02, backend="cpu", log=False) as made:
        yield made


def c_address(world, number):
    """What the C interface says of an output's memory."""
    raw = _native.OutputView()
    assert native.wadi_world_get_view(world.id, number, _native.OutputSet.CURRENT, ctypes.byref(raw)) == 0
    return raw.handle + raw.offset, raw.row_pitch


def test_views_have_the_addresses_of_the_library(world):
    world.set_outputs("free_surface", "flow", "packed_half")
    world.step(5)
    world.publish()
    for name, channels, size in (("free_surface", 1, 4), ("flow", 2, 4), ("packed_half", 4, 2)):
        view = world.view(name)
        address, pitch = c_address(world, wadi.Output[name.upper()])
        array, tensor = np.asarray(view), np.from_dlpack(view)
        for found in (array, tensor):
            assert found.__array_interface__["data"][0] == address
            assert found.strides[0] == pitch and found.shape[:2] == (32, 64) and found.itemsize == size
            assert found.size == 32 * 64 * channels
        assert array.base is view and not array.flags.writeable and np.array_equal(array, tensor)
        assert world.output(name).__array_interface__["data"][0] != address  # the control: a copy lies elsewhere
        assert np.array_equal(world.output(name), array)
    assert np.array_equal(np.asarray(world.view("free_surface")), world.read("free_surface"))
    assert view.step == 5 and view.__dlpack_device__() == (1, 0)


def test_a_view_shows_its_publish_until_the_second_next(world):
    world.set_outputs("water_depth")
    world.publish()
    view = world.view("water_depth")
    array, first = np.asarray(view), world.read("water_depth")
    world.step(20)
    world.publish()
    assert np.array_equal(array, first) and np.array_equal(np.asarray(world.view("water_depth", "previous")), first)
    second = np.asarray(world.view("water_depth"))
    assert np.array_equal(second, world.read("water_depth")) and not np.array_equal(second, first)


@pytest.mark.parametrize("hold", [np.asarray, np.from_dlpack, lambda view: np.asarray(view)[3:5, ::2]])
def test_memory_outlives_the_world_as_long_as_a_view_does(world, hold):
    world.set_outputs("free_surface")
    world.publish()
    array = hold(world.view("free_surface"))
    copy = array.copy()
    handle = world.id
    with pytest.raises(BufferError, match="set_outputs: 1 views of outputs are alive"):
        world.set_outputs("flow")
    world.close()
    gc.collect()
    seconds = ctypes.c_double()
    assert native.wadi_world_get_time(handle, ctypes.byref(seconds), None) == 0  # it is still there
    assert np.array_equal(array, copy)
    del array
    gc.collect()
    assert native.wadi_world_get_time(handle, ctypes.byref(seconds), None) == wadi.Result.ERROR_BAD_ARGUMENT
    assert not output._lent


def test_capsules_that_nobody_takes_are_freed(world):
    world.set_outputs("free_surface")
    world.publish()
    capsule = world.view("free_surface").__dlpack__()
    assert len(output._lent) == 1
    del capsule
    gc.collect()
    assert not output._lent and not world._handle.views
    world.set_outputs("flow")


def test_what_views_refuse(world):
    with pytest.raises(wadi.BadArgumentError):
        world.view("flow")
    world.set_outputs("flow")
    with pytest.raises(wadi.NotReadyError):
        world.view("flow")
    world.publish()
    view = world.view("flow")
    with pytest.raises(BufferError, match="no streams on the CPU"):
        view.__dlpack__(stream=1)
    for given in ({"dl_device": (2, 0)}, {"copy": True}):
        with pytest.raises(BufferError, match="shares memory on its own device"):
            view.__dlpack__(**given)
    with pytest.raises(AttributeError, match="on the CPU"):
        view.__cuda_array_interface__
    with pytest.raises(ValueError, match="output: there is no 'flows'; there are terrain"):
        world.view("flows")


def test_outputs_of_a_host(world):
    world.set_outputs("free_surface", host=True)
    world.step(3)
    world.publish()
    assert np.array_equal(world.output("free_surface"), world.read("free_surface"))


def test_device_arrays_need_a_world_on_cuda(world):
    class Fake:
        __cuda_array_interface__ = {"shape": (32, 64), "typestr": "<f4", "data": (4096, False), "version": 3, "strides": None}

    with pytest.raises(wadi.NotSupportedError, match="needs a world on cuda; this one is on cpu"):
        world.write("sand_depth", Fake())
    Fake.__cuda_array_interface__ = {**Fake.__cuda_array_interface__, "typestr": "<f8"}
    with pytest.raises(ValueError, match="values: their type is <f8, must be <f4"):
        world.write("sand_depth", Fake())
    with pytest.raises(wadi.NotSupportedError):
        from wadi import cuda

        cuda.signal(world)
