// voxel_distance.glsl -- the lower envelope of the parabolas before(i) + side^2 (q - i)^2 of a column of voxels.
//
// Before including: VOXEL_BEFORE, sampler of `before`, and the functions `place` (of voxel i of the thread's column),
// `envelope_index` (where its k-th voxel of the envelope is kept) and `keep` (of the
// result at voxel q), and column_last (the last voxel of a column).

float before(int i)
{
    float least = texelFetch(VOXEL_BEFORE, place(i), 0).r;
    if (args.reach != 0u) { // neighbours count as what is at their side
        least = min(least, texelFetch(VOXEL_BEFORE, place(max(i - 1, 0)), 0).r);
        least = min(least, texelFetch(VOXEL_BEFORE, place(min(i + 1, column_last())), 0).r);
    }
    return least;
}

// Where the parabolas of i and of j > i meet.
float meeting(int i, float of_i, int j, float of_j, float side)
{
    return 0.5 * (float(i) + float(j)) + (of_j - of_i) / (2.0 * side * side * float(j - i));
}

void column_distances(int count, float side)
{
    int last = -1, top = 0; // of the envelope: how many less one, and its last voxel
    float of_top = 0.0, from = -1e30; // before(top), and from where on it is the lowest
    for (int q = 0; q < count; q++) {
        const float of_q = before(q);
        if (of_q >= VOXEL_DISTANCE_NONE) {
            continue;
        }
        float meet = last < 0 ? -1e30 : meeting(top, of_top, q, of_q, side);
        while (last > 0 && meet <= from) { // the top one is nowhere the lowest
            last--;
            top = int(envelope[envelope_index(last)]);
            of_top = before(top);
            from = -1e30;
            if (last > 0) {
                const int below = int(envelope[envelope_index(last - 1)]);
                from = meeting(below, before(below), top, of_top, side);
            }
            meet = meeting(top, of_top, q, of_q, side);
        }
        last++;
        envelope[envelope_index(last)] = uint(q);
        top = q;
        of_top = of_q;
        from = meet;
    }
    int k = 0, at = 0, next = 0;
    float of_at = 0.0, of_next = 0.0;
    if (last >= 0) {
        at = int(envelope[envelope_index(0)]);
        of_at = before(at);
    }
    if (last > 0) {
        next = int(envelope[envelope_index(1)]);
        of_next = before(next);
    }
    for (int q = 0; q < count; q++) {
        float here = of_at + side * side * float(q - at) * float(q - at);
        float there = of_next + side * side * float(q - next) * float(q - next);
        while (k < last && there <= here) {
            k++;
            at = next;
            of_at = of_next;
            here = there;
            next = int(envelope[envelope_index(min(k + 1, last))]);
            of_next = before(next);
            there = of_next + side * side * float(q - next) * float(q - next);
        }
        keep(q, last < 0 ? VOXEL_DISTANCE_NONE : here);
    }
}
