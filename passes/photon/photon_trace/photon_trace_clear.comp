// photon_trace_clear.comp -- empties the slots that this frame's generations go to.
#include "photon_trace_args.h"
#include "../common/photon_args.h"

layout(local_size_x = PHOTON_TRACE_GROUP) in;
TYN_ARGS(photon_turn_args args);
TYN_UPDATE(0, ring, photon_ring ring; ivec4 words[]);
TYN_WRITE(1, flux, ivec4 flux_words[]);

void main()
{
    // A ring that was just started is empty.
    if (ring.first == 0u || gl_GlobalInvocationID.x >= args.quads) {
        return;
    }
    for (uint i = 0u; i < args.each; i++) {
        uint at = (ring.first + i) % args.slots * args.quads + gl_GlobalInvocationID.x;
        words[at] = ivec4(0);
        flux_words[at] = ivec4(0);
    }
}
