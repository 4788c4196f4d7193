// Items numbered over workgroups that gpu::linearGroups folded into two axes.
#ifndef LUMULUS_LIB_LINEAR
#define LUMULUS_LIB_LINEAR

uint linearGroup() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

/// `groupSize` is local_size_x; lavapipe 22.3 has gl_WorkGroupSize wrong.
uint linearInvocation(uint groupSize) { return linearGroup() * groupSize + gl_LocalInvocationID.x; }

/// The cell of a grid that has this number, x fastest.
ivec3 cellNumbered(uint number, ivec3 cells) {
    const uvec3 size = uvec3(cells);
    return ivec3(number % size.x, (number / size.x) % size.y, number / (size.x * size.y));
}

#endif
