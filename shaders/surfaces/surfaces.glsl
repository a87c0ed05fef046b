// surfaces.glsl -- the surfaces of the scene.
//
// Define GEOMETRY_AT as the first binding of the bundle TYN_GEOMETRY (bundles.h), or MATERIALS_AT as that of
// TYN_MATERIALS (reflectance.glsl has what reads materials), or both. The structs of surface_args.h are read as rows of
// four: a CPU device reads a vector per lane in little more than the time of a number. All are texels, as threads
// that run together read places of their own. A kernel that defines SURFACE_FEW, a specialisation constant (0, or the
// number of triangles if they are at most TYN_SURFACE_FEW), tries them one after another; with SURFACE_KEPT it keeps their
// corners (surface_load_few).
#ifndef TYN_SURFACES_GLSL
#define TYN_SURFACES_GLSL
#include "surface_args.h"

#ifdef GEOMETRY_AT
TYN_UNIFORM(GEOMETRY_AT, surfaces, surface_block surfaces);
layout(set = 0, binding = GEOMETRY_AT + 1) uniform samplerBuffer vertices_texels;
layout(set = 0, binding = GEOMETRY_AT + 2) uniform usamplerBuffer triangles_texels;
layout(set = 0, binding = GEOMETRY_AT + 3) uniform usamplerBuffer nodes_texels;

// Position, u.
vec4 surface_vertex_place(uint vertex)
{
    return texelFetch(vertices_texels, int(2u * vertex));
}

// Normal, v.
vec4 surface_vertex_facing(uint vertex)
{
    return texelFetch(vertices_texels, int(2u * vertex + 1u));
}

vec3 surface_position(uint vertex)
{
    return surface_vertex_place(vertex).xyz;
}

// Corners, material.
uvec4 surface_triangle_at(uint index)
{
    return texelFetch(triangles_texels, int(index));
}

// Row 0 of a node: lo, first; row 1: hi, count.
uvec4 surface_node_row(uint node, uint row)
{
    return texelFetch(nodes_texels, int(2u * node + row));
}

#ifndef SURFACE_FEW
#define SURFACE_FEW 0u
#endif
#ifndef SURFACE_KEPT
#define SURFACE_KEPT false
#endif
surface_corners surface_few[TYN_SURFACE_FEW];

// Where SURFACE_FEW is not 0, before rays are traced. A processor reads a uniform array thread by thread wherever threads
// have diverged, and has room for copies; a graphics card reads it for all at once, and has not.
void surface_load_few()
{
    [[unroll]] for (uint i = 0u; i < (SURFACE_KEPT ? SURFACE_FEW : 0u); i++) {
        surface_few[i] = surfaces.few[i];
    }
}

surface_corners surface_corners_of(uint i)
{
    if (SURFACE_KEPT) {
        return surface_few[i];
    }
    surface_corners c = surfaces.few[i];
    return c;
}

vec2 surface_uv(uint vertex)
{
    return vec2(surface_vertex_place(vertex).w, surface_vertex_facing(vertex).w);
}

// Texture coordinates of a triangle's first corner, and of the others from there.
mat3x2 surface_uvs(uvec4 triangle)
{
    vec2 first = surface_uv(triangle.x);
    return mat3x2(first, surface_uv(triangle.y) - first, surface_uv(triangle.z) - first);
}
#endif
#ifdef MATERIALS_AT
layout(set = 0, binding = MATERIALS_AT) uniform usamplerBuffer materials_texels;
layout(set = 0, binding = MATERIALS_AT + 1) uniform usamplerBuffer textures_words;
layout(set = 0, binding = MATERIALS_AT + 2) uniform usamplerBuffer texels_words;

surface_material surface_material_at(uint index)
{
    uvec4 reflected = texelFetch(materials_texels, int(2u * index));
    uvec4 sent = texelFetch(materials_texels, int(2u * index + 1u));
    return surface_material(uintBitsToFloat(reflected.rgb), reflected.a, uintBitsToFloat(sent.rgb), sent.a);
}

uint surface_texture_word(uint index, uint word)
{
    return texelFetch(textures_words, int(6u * index + word)).r;
}

surface_texture surface_texture_at(uint index)
{
    uint w[6];
    for (uint i = 0u; i < 6u; i++) {
        w[i] = surface_texture_word(index, i);
    }
    return surface_texture(w[0], w[1], uvec2(w[2], w[3]), uvec2(w[4], w[5]));
}
#endif

#endif
