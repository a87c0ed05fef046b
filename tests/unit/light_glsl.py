"""light_glsl.py -- the include for hosts, tyndall/light.glsl, compiles as they use it: in shaders of every stage, from the
first version that it names on, for Vulkan and for OpenGL, and twice in one shader.

usage: light_glsl.py GLSLANG FOLDER_OF_PUBLIC_HEADERS
"""
import subprocess
import sys
import tempfile
from pathlib import Path

STAGES = {
    "vert": ("", "gl_Position = vec4(lit, 1.0);"),
    "frag": ("layout(location = 0) out vec4 colour;", "colour = vec4(lit, 1.0);"),
    "comp": ("layout(local_size_x = 8, local_size_y = 8) in;\n"
             "layout(binding = 4, rgba16f) uniform writeonly image2D picture;",
             "imageStore(picture, ivec2(gl_GlobalInvocationID.xy), vec4(lit, 1.0));"),
}
SHADER = """#version %s core
#extension GL_GOOGLE_include_directive : require
#include "tyndall/light.glsl"
#include "tyndall/light.glsl"
layout(binding = 0) uniform sampler3D red;
layout(binding = 1) uniform sampler3D green;
layout(binding = 2) uniform sampler3D blue;
layout(binding = 3, std140) uniform host { mat4 world_to_texture; vec4 position, normal, to_eye; };
%s
void main()
{
    tyn_light light = tyn_light_at(red, green, blue, world_to_texture, position.xyz);
    vec3 lit = tyn_light_irradiance(light, normal.xyz) + tyn_light_inscatter(light, position.w, to_eye.xyz);
    %s
}
"""
TARGETS = {"Vulkan": ["-V", "--target-env", "vulkan1.0"], "OpenGL": ["-G", "--aml", "--amb"]}


def main():
    glslang, include = sys.argv[1:]
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for stage, (declared, used) in STAGES.items():
            for version in ("450", "460"):
                source = Path(folder) / f"host.{stage}"
                source.write_text(SHADER % (version, declared, used))
                for target, options in TARGETS.items():
                    made = subprocess.run([glslang, *options, f"-I{include}", str(source), "-o", f"{source}.spv"],
                                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                    if made.returncode != 0 or "WARNING" in made.stdout:
                        failed += 1
                        print(f"{target}, GLSL {version}, {stage}:\n{made.stdout}")
    sys.exit(failed > 0)


main()
