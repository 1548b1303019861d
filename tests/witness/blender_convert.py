# Imports a mesh into Blender and exports it again, in the format of each name:
#   blender -b --python blender_convert.py -- IN OUT...
import sys

import numpy

numpy.bool = bool  # Debian's Blender 3.4 still uses the alias that its numpy has dropped
import bpy

source, *targets = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.read_factory_settings(use_empty=True)
IMPORTS = {
    "glb": bpy.ops.import_scene.gltf,
    "gltf": bpy.ops.import_scene.gltf,
    "obj": bpy.ops.import_scene.obj,
    "ply": bpy.ops.import_mesh.ply,
    "stl": bpy.ops.import_mesh.stl,
}
IMPORTS[source.rsplit(".", 1)[1]](filepath=source)
bpy.ops.object.select_all(action="SELECT")
bpy.context.view_layer.objects.active = next(o for o in bpy.context.scene.objects if o.type == "MESH")
for target in targets:
    ending = target.rsplit(".", 1)[1]
    if ending == "glb":
        bpy.ops.export_scene.gltf(filepath=target, export_format="GLB")
    elif ending == "obj":
        bpy.ops.export_scene.obj(filepath=target)
    elif ending == "ply":
        bpy.ops.export_mesh.ply(filepath=target)
    elif ending == "stl":
        bpy.ops.export_mesh.stl(filepath=target)
