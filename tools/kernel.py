#!/usr/bin/env python3
"""kernel.py -- compiles a shader and writes it as a C header, with what its SPIR-V says of its interface.

    kernel.py GLSLANG OUTPUT INPUT arguments of glslang...

INPUT is passes/<pass>/<kernel>.comp, .vert or .frag; `--vn` among the arguments names the array of words. A shader without a
#version is compiled behind PREAMBLE. Beside the words the header has, for TYN_KERNEL and TYN_DRAW (tyndall/pass.h):

    <kernel>_bindings[]   a tyn_binding of each descriptor, in the order of their binding numbers
    <kernel>_args_size, _num_spec, _x, _y, _z    bytes of push constants, specialisation constants, workgroup

A descriptor belongs to the port that its name says: the name of the block, or of the image, without

    _uniform, _buffer                  of blocks: TYN_UNIFORM, TYN_READ, TYN_WRITE, TYN_UPDATE (shaders/common/shared.h)
    _tex, _image                       sampled, stored to
    _wrapped                           sampled, and repeated along x (latitude and longitude)
    _texels, _words                    a buffer read by texelFetch, four words at a time, or one

and a number behind it, where a kernel binds one port several times. So `sky_image2` is <PASS>_PORT_SKY.
"""
import os
import re
import struct
import subprocess
import sys

PREAMBLE = '#version 460\n#extension GL_GOOGLE_include_directive : require\n'
SUFFIX = re.compile(r'_(uniform|buffer|tex|image|wrapped|texels|words)\d*$')
NAME, DECORATE, MEMBER_DECORATE, EXECUTION_MODE_ID = 5, 71, 72, 331
TYPE_INT, TYPE_FLOAT, TYPE_VECTOR, TYPE_MATRIX, TYPE_IMAGE, TYPE_SAMPLED_IMAGE = 21, 22, 23, 24, 25, 27
TYPE_ARRAY, TYPE_STRUCT, TYPE_POINTER, CONSTANT, VARIABLE = 28, 30, 32, 43, 59
SPEC_ID, ARRAY_STRIDE, NON_WRITABLE, NON_READABLE, BINDING, DESCRIPTOR_SET, OFFSET = 1, 6, 24, 25, 33, 34, 35
UNIFORM, PUSH_CONSTANT, STORAGE_BUFFER, LOCAL_SIZE_ID, DIM_BUFFER = 2, 9, 12, 38, 5


def fail(text):
    sys.exit(f'kernel.py: {sys.argv[3]}: {text}')


class Module:
    def __init__(self, words):
        self.names, self.decorations, self.members = {}, {}, {}
        self.types, self.constants, self.variables, self.local_size = {}, {}, [], ()
        at = 5
        while at < len(words):
            op, length = words[at] & 0xffff, words[at] >> 16
            self.read(op, words[at + 1:at + length])
            at += length

    def read(self, op, w):
        if op == NAME:
            self.names[w[0]] = struct.pack(f'<{len(w) - 1}I', *w[1:]).split(b'\0')[0].decode()
        elif op == DECORATE:
            self.decorations[w[0], w[1]] = w[2] if len(w) > 2 else True
        elif op == MEMBER_DECORATE:
            self.members[w[0], w[1], w[2]] = w[3] if len(w) > 3 else True
        elif op == EXECUTION_MODE_ID and w[1] == LOCAL_SIZE_ID:
            self.local_size = w[2:5]
        elif op in (TYPE_INT, TYPE_FLOAT, TYPE_VECTOR, TYPE_MATRIX, TYPE_IMAGE, TYPE_SAMPLED_IMAGE, TYPE_ARRAY,
                    TYPE_STRUCT, TYPE_POINTER):
            self.types[w[0]] = (op, w[1:])
        elif op == CONSTANT:
            self.constants[w[1]] = w[2]
        elif op == VARIABLE:
            self.variables.append((w[1], self.types[w[0]][1][1], w[2]))

    def bytes(self, type):
        op, w = self.types[type]
        if op in (TYPE_INT, TYPE_FLOAT):
            return w[0] // 8
        if op in (TYPE_VECTOR, TYPE_MATRIX):
            return w[1] * self.bytes(w[0])
        if op == TYPE_ARRAY:
            return self.constants[w[1]] * self.decorations.get((type, ARRAY_STRIDE), self.bytes(w[0]))
        return max(self.members[type, i, OFFSET] + self.bytes(t) for i, t in enumerate(w))

    def has(self, variable, type, which):
        """A decoration that images carry themselves and buffers on every member."""
        op, w = self.types[type]
        return (variable, which) in self.decorations or \
            op == TYPE_STRUCT and all((type, i, which) in self.members for i in range(len(w)))

    def use(self, name, variable, type, storage):
        op, w = self.types[type]
        if op == TYPE_SAMPLED_IMAGE:
            return 'TYN_USE_SAMPLED'
        if op == TYPE_IMAGE and w[1] == DIM_BUFFER:
            if w[5] != 1:
                fail(f'{name}: image buffers are not bound by any use')
            scalar = re.search(r'_words\d*$', name)
            if self.types[w[0]][0] == TYPE_FLOAT:
                return 'TYN_USE_TEXELS_FLOAT' if scalar else 'TYN_USE_TEXELS_VEC4'
            return 'TYN_USE_TEXELS_UINT' if scalar else 'TYN_USE_TEXELS_UVEC4'
        if storage == UNIFORM:
            return 'TYN_USE_UNIFORM'
        if storage != STORAGE_BUFFER and op != TYPE_IMAGE:
            fail(f'{name} is neither an image nor a buffer')
        if self.has(variable, type, NON_WRITABLE):
            return 'TYN_USE_STORAGE_READ'
        return 'TYN_USE_STORAGE_WRITE' if self.has(variable, type, NON_READABLE) else 'TYN_USE_STORAGE_RW'

    def bindings(self, pass_name):
        rows = {}
        for variable, type, storage in self.variables:
            at = self.decorations.get((variable, BINDING))
            if at is None:
                continue
            if self.decorations.get((variable, DESCRIPTOR_SET), 0) != 0:
                fail(f'binding {at} is in another set than 0')
            name = self.names[type if self.types[type][0] == TYPE_STRUCT else variable]
            if at in rows:
                fail(f'binding {at} is given twice')
            port = f'{pass_name}_PORT_{SUFFIX.sub("", name)}'.upper()
            wrapped = 'true' if re.search(r'_wrapped\d*$', name) else 'false'
            rows[at] = f'    {{{port}, {self.use(name, variable, type, storage)}, {wrapped}}},\n'
        if sorted(rows) != list(range(len(rows))):
            fail(f'bindings must be 0 to {len(rows) - 1}, are {sorted(rows)}')
        return ''.join(rows[at] for at in sorted(rows))


def with_preamble(source, output, arguments):
    """The arguments of glslang: for the shader, or for a file beside the output that includes it behind PREAMBLE."""
    with open(source) as file:
        if re.search(r'^#version', file.read(), re.M):
            return arguments
    folder, name = os.path.split(source)
    whole = output + os.path.splitext(source)[1]
    with open(whole, 'w') as file:
        file.write(f'{PREAMBLE}#include "{name}"\n')
    return [whole if argument == source else argument for argument in arguments] + [f'-I{folder or "."}']


def main():
    glslang, output, source = sys.argv[1:4]
    name = sys.argv[sys.argv.index('--vn') + 1].removesuffix('_spirv')
    if subprocess.run([glslang, *with_preamble(source, output, sys.argv[4:])]).returncode != 0:
        sys.exit(1)
    with open(output) as file:
        text = file.read()
    module = Module([int(w, 16) for w in re.findall(r'0x[0-9a-f]{8}', text)])
    args = [module.bytes(type) for _, type, storage in module.variables if storage == PUSH_CONSTANT]
    specs = [value for (_, which), value in module.decorations.items() if which == SPEC_ID]
    rows = module.bindings(os.path.basename(os.path.dirname(source)))
    size = ''.join(f', {name}_{axis} = {module.constants[i]}' for axis, i in zip('xyz', module.local_size))
    with open(output, 'a') as file:
        if rows:
            file.write(f'static const tyn_binding {name}_bindings[] = {{\n{rows}}};\n')
        file.write(f'enum {{ {name}_args_size = {sum(args)}, {name}_num_spec = {max(specs, default=-1) + 1}{size} }};\n')


main()
