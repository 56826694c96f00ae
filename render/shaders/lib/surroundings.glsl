// What reaches a surface from all around, lights apart: the layer 0 of the reflection maps and its irradiance.

#include "lib/irradiance.glsl"
#include "lib/reflection_map.glsl"
#include "lib/sky.glsl"

layout(binding = 7) uniform sampler2DArray reflection_maps;
layout(std140, binding = 5) uniform Surroundings {
    Irradiance surroundings[kReflectionLayers];
};

struct Around {
    vec3 irradiance;  // / pi
    vec3 mirrored;    // radiance
};

Around light_from_around(vec3 normal, vec3 mirror_direction, float roughness) {
    return Around(
        irradiance_toward(surroundings[0], normal),
        reflected_radiance(reflection_maps, 0.0, environment.reflection.xy, mirror_direction, roughness));
}
