// walls_place.glsl -- places in the lattice. Include after lattice.glsl and walls_triangle.glsl, with args
// (extent, dims), and after surfaces.glsl with GEOMETRY_AT.
#ifndef TYN_WALLS_PLACE_GLSL
#define TYN_WALLS_PLACE_GLSL

uint walls_cell_index(ivec3 c)
{
    return (uint(c.z) * args.dims.y + uint(c.y)) * args.dims.x + uint(c.x);
}

// World -> lattice: centres, moved by the shift, at whole numbers. Every triangle of a vertex gets the same
// place for it.
vec3 walls_lattice_place(vec3 world)
{
    precise vec3 m = vec3(dot(surfaces.from_world[0].xyz, world) + surfaces.from_world[0].w,
                          dot(surfaces.from_world[1].xyz, world) + surfaces.from_world[1].w,
                          dot(surfaces.from_world[2].xyz, world) + surfaces.from_world[2].w);
    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    precise vec3 place = (m - box.origin) / box.dx - 0.5 -
                         vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z);
    return place;
}

walls_triangle walls_triangle_at(uint i)
{
    uvec4 t = surface_triangle_at(i);
    return walls_triangle_of(walls_lattice_place(surface_position(t.x)), walls_lattice_place(surface_position(t.y)),
                             walls_lattice_place(surface_position(t.z)));
}

#endif
