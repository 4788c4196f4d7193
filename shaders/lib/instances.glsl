// The upper level of the traversal: the list of instances. A line is cut into segments in which it meets the same instances;
// where it is in several at once, segments are so short that their order within one does not matter. The includer declares
// `params`, the constant MANY (more than one instance) and, in main(), calls loadInstances().
#ifndef LUMULUS_LIB_INSTANCES
#define LUMULUS_LIB_INSTANCES

#include "shared/draw.h"
#include "lib/density.glsl"
#include "lib/traversal.glsl"

layout(binding = 12, scalar) readonly buffer Instances { InstanceParams instances[]; };

// Held in registers where there is but one: a load from a buffer costs a loop over the lanes on lavapipe, in every step.
InstanceParams onlyInstance;

void loadInstances() {
    if (!MANY) onlyInstance = instances[0];
}

InstanceParams instanceAt(int number) {
    if (MANY) return instances[number];
    return onlyInstance;
}

/// A ray (metres, relative to the eye) in the voxel coordinates of an instance.
Line lineIn(InstanceParams instance, vec3 origin, vec3 direction) {
    return lineFrom(instance.eyeVoxel + instance.worldToVoxel * origin, instance.worldToVoxel * direction);
}

/// Density of an instance, normalised. In an atlas neighbours must not shine through: the outermost voxels are empty.
float densityIn(InstanceParams instance, sampler3D density, vec3 voxel) {
    if (!MANY) return densityAt(density, voxel, 1.0 / instance.size);
    return densityAt(density, instance.densityOrigin + clamp(voxel, vec3(0.5), instance.size - 0.5), params.atlas.density);
}

#endif
