#!/bin/sh
# devices.sh -- `tyndall info --devices` lists each row of the table of needs, and the fallbacks of a device with least limits.
# usage: devices.sh TYNDALL STRICT_DRIVER_JSON
set -eu
export VK_DRIVER_FILES="$2" VK_ICD_FILENAMES="$2"

listed=$("$1" info --devices) || {
    echo "skipped: all cases (no Vulkan device)"
    exit 77
}

has()
{
    echo "$listed" | grep -q -- "$1" || {
        echo "no line '$1' in:" >&2
        echo "$listed" >&2
        exit 1
    }
}

has "^0  strict device$"
has ", usable$"
has "^   has   feature scalarBlockLayout: "
has "^   has   format R32G32B32A32_SFLOAT: "
has "^   has   format D32_SFLOAT: "
has "^   has   limit maxStorageBufferRange >= 134217728: "
has "^   has   limit maxTexelBufferElements >= 33554432: "
has "^   lacks limit maxImageDimension2D >= 16384: .*; instead: smaller pictures"
has "^   lacks limit maxImageDimension3D >= 2048: .*; instead: a scene that needs a larger one is refused"
has "^   lacks queue timestamps: .*; instead: no times"
has "^   lacks limit maxComputeSharedMemorySize >= 32768: .*; instead: fewer cells"
has "^   lacks extension VK_NV_shader_sm_builtins: .*; instead: "
! echo "$listed" | grep "; required" || exit 1 # it is usable
