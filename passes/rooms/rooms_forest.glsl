// rooms_forest.glsl -- disjoint sets in a buffer, joined by many threads at once (Jayanti and Tarjan, "A randomized
// concurrent algorithm for disjoint set union", PODC 2016, with the order of the elements for the random one).
//
// Element i holds how far its parent is before it: 0 for the first of a set. Links go to earlier elements only, so
// that the first of a set does not depend on the order in which sets are joined.
#extension GL_KHR_memory_scope_semantics : require

layout(binding = 0, scalar) coherent buffer forest_buffer
{
    uint forest[];
};

uint rooms_up(uint i)
{
    return atomicLoad(forest[i], gl_ScopeDevice, gl_StorageSemanticsNone, gl_SemanticsRelaxed);
}

uint rooms_first(uint i)
{
    uint up = rooms_up(i);
    while (up != 0u) {
        uint parent = i - up, further = rooms_up(parent);
        if (further != 0u) {
            // Halves the way of those that come after.
            atomicStore(forest[i], up + further, gl_ScopeDevice, gl_StorageSemanticsNone, gl_SemanticsRelaxed);
        }
        i = parent - further;
        up = rooms_up(i);
    }
    return i;
}

void rooms_join(uint a, uint b)
{
    a = rooms_first(a);
    b = rooms_first(b);
    while (a != b) {
        uint low = min(a, b), high = max(a, b);
        uint up = atomicCompSwap(forest[high], 0u, high - low);
        if (up == 0u) {
            break;
        }
        a = rooms_first(high - up); // another thread was faster
        b = rooms_first(low);
    }
}
