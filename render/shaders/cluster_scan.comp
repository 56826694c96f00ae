// The start of each cell's list: the exclusive prefix sum of the lengths. One group; each invocation sums a run of
// cells, the group scans the runs.
#version 450
#include "cluster_gpu.h"

layout(local_size_x = 1024) in;  // the largest size that OpenGL guarantees: runs are read one cell after another
layout(std430, binding = kClusterCellsBinding) buffer Cells {
    uvec2 cells[];  // begin and length of each list
};

uniform uint cell_count;

shared uint sums[gl_WorkGroupSize.x];

void main() {
    uint i = gl_LocalInvocationID.x;
    uint run = (cell_count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    uint first = min(i * run, cell_count);
    uint end = min(first + run, cell_count);
    uint sum = 0u;
    for (uint cell = first; cell < end; ++cell) {
        sum += cells[cell].y;
    }
    sums[i] = sum;
    // Hillis and Steele 1986: after step n, sums[i] covers the 2^n runs that end with i.
    for (uint stride = 1u; stride < gl_WorkGroupSize.x; stride *= 2u) {
        barrier();
        uint before = i >= stride ? sums[i - stride] : 0u;
        barrier();
        sums[i] += before;
    }
    uint begin = sums[i] - sum;
    for (uint cell = first; cell < end; ++cell) {
        cells[cell].x = begin;
        begin += cells[cell].y;
    }
}
