"""Wadi in Blender: bakes sand and water on a height field to animated meshes. The manifest beside this names the wheel of wadi."""
from . import interface, objects


def register():
    interface.register()
    objects.register()


def unregister():
    objects.unregister()
    interface.unregister()
