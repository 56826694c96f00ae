// Environment light on a surface: from the sky or, with definition PROBES and within their influence, from probes.
// Techniques: env.capture, env.reflect

#include "lib/irradiance.glsl"
#include "lib/reflection_map.glsl"
#include "lib/sky.glsl"
#include "lib/view.glsl"
#include "environment_gpu.h"

layout(binding = kReflectionMapsUnit) uniform sampler2DArray reflection_maps;
layout(std140, binding = kSurroundingsBinding) uniform Surroundings {
    Irradiance surroundings[kReflectionLayers];
};

struct EnvironmentLight {
    vec3 irradiance;  // / pi
    vec3 mirrored;    // radiance
};

#ifdef PROBES
#ifndef OPAQUE_UNIFORMS
layout(std140, binding = kProbesBinding) uniform Probes {
    ProbeBlock probe_block;
};
#else  // see lib/view.glsl
layout(std140, binding = kProbesBinding) uniform Probes {
    ProbeBlock probe_blocks[1];
};
#define probe_block probe_blocks[min(int(view.size.x), 0)]
#endif

// Transforms from world space to probe space, where the region is the unit ball or cube.
vec3 to_probe_space(ProbeRecord probe, vec3 v, float w) {
    vec4 p = vec4(v, w);
    return vec3(
        dot(probe.probe_from_world[0], p), dot(probe.probe_from_world[1], p), dot(probe.probe_from_world[2], p));
}

// 1 inside, with a smooth falloff to 0 over the border.
float probe_weight(ProbeRecord probe, vec3 position) {
    vec3 p = to_probe_space(probe, position, 1.0);
    vec3 size = abs(p);
    float outward = probe.shape.x > 0.5 ? max(size.x, max(size.y, size.z)) : length(p);
    return 1.0 - smoothstep(0.0, 1.0, (outward - 1.0) * probe.shape.y);
}

// Parallax-corrected lookup direction: from the probe toward the point where the ray from `position` along `direction`
// hits the room's walls (Lagarde and Zanuttini, "Local Image-based Lighting with Parallax-corrected Cubemaps", 2012).
// From outside the room, the far wall.
vec3 probe_direction(ProbeRecord probe, vec3 position, vec3 direction) {
    if (probe.shape.x < 0.5) {
        return direction;
    }
    vec3 p = to_probe_space(probe, position, 1.0);
    vec3 d = to_probe_space(probe, direction, 0.0);
    vec3 inverse = 1.0 / mix(d, vec3(1e-8), lessThan(abs(d), vec3(1e-8)));
    vec3 distances = max((1.0 - p) * inverse, (-1.0 - p) * inverse);
    float path = max(min(distances.x, min(distances.y, distances.z)), 0.0);
    return position + path * direction - probe.capture_position.xyz;
}
#endif

EnvironmentLight environment_light(vec3 position, vec3 normal, vec3 mirror_direction, float roughness) {
    EnvironmentLight sum = EnvironmentLight(vec3(0.0), vec3(0.0));
    float remaining = 1.0;
#ifdef PROBES
    int count = int(probe_block.count.x);
    for (int i = 0; i < count; ++i) {
        ProbeRecord probe = probe_block.probes[i];
        float weight = remaining * probe_weight(probe, position);
        if (weight > 0.0) {
            vec3 direction = probe_direction(probe, position, mirror_direction);
            float layer = probe.capture_position.w;
            sum.irradiance += weight * irradiance_toward(surroundings[int(layer)], normal);
            sum.mirrored += weight
                            * reflected_radiance(
                                reflection_maps, layer, environment.reflection.xy, direction, roughness);
            remaining -= weight;
        }
    }
    if (remaining <= 0.0) {
        return sum;
    }
#endif
    sum.irradiance += remaining * irradiance_toward(surroundings[0], normal);
    sum.mirrored +=
        remaining * reflected_radiance(reflection_maps, 0.0, environment.reflection.xy, mirror_direction, roughness);
    return sum;
}
