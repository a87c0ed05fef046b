// shared.h -- lets one header describe a struct, or a function, to C and to GLSL (scalar block layout on both sides).
#ifndef TYN_SHARED_H
#define TYN_SHARED_H

#ifdef __STDC__
#include <stdint.h>
#include <assert.h>
typedef uint32_t tyn_uint;
typedef float tyn_vec2[2];
typedef float tyn_vec3[3];
typedef float tyn_vec4[4];
typedef uint32_t tyn_uvec2[2];
typedef uint32_t tyn_uvec3[3];
// Size in bytes that scalar layout gives the struct.
#define TYN_ASSERT_SIZE(type, bytes) static_assert(sizeof(struct type) == (bytes), #type)
#define TYN_STRUCT(type) struct type // names a struct within another one
#define TYN_FUNCTION static inline   // of numbers only, by operators that both languages have
#else
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define tyn_uint uint
#define tyn_vec2 vec2
#define tyn_vec3 vec3
#define tyn_vec4 vec4
#define tyn_uvec2 uvec2
#define tyn_uvec3 uvec3
#define TYN_ASSERT_SIZE(type, bytes)
#define TYN_STRUCT(type) type
#define TYN_FUNCTION

// clang-format off
// Buffers of a kernel: binding, name of the port (tyndall/pass.h), members.
//   TYN_READ(3, lights, light_block lights[]);
#define TYN_UNIFORM(at, port, members) layout(set = 0, binding = at, scalar) uniform port##_uniform { members; }
#define TYN_READ(at, port, members) layout(set = 0, binding = at, scalar) readonly buffer port##_buffer { members; }
#define TYN_WRITE(at, port, members) layout(set = 0, binding = at, scalar) writeonly buffer port##_buffer { members; }
#define TYN_UPDATE(at, port, members) layout(set = 0, binding = at, scalar) buffer port##_buffer { members; }
// Its push constants: TYN_ARGS(merge_args args);
#define TYN_ARGS(members) layout(push_constant, scalar) uniform args_block { members; }
// clang-format on
#endif

#endif
