// Radiance of the environment by direction. The same functions give the background, the reflections and the
// ambient light; the same as render/environment/environment_light.cpp, except for the panorama (3), which is a cube map.
// SKY_KIND, as numbered by SkyKind, is fixed at compile time.

#include "environment_gpu.h"

layout(std140, binding = kEnvironmentBinding) uniform Environment {
    EnvironmentBlock environment;
};

#ifdef SKY_KIND
#if SKY_KIND == 3
layout(binding = kSkyCubeUnit) uniform samplerCube sky_cube;  // with all its mip levels
#elif SKY_KIND == 4
layout(binding = kSkyCubeUnit) uniform sampler2D sky_view;  // SkyView (atmosphere.h)

// Light of the sun that the air scatters. zenith = irradiance of the sun above the air, ground = radiance.
vec3 atmosphere_sky(vec3 d) {
    vec2 to_sun = environment.sun_direction.xz;
    float cosine = dot(to_sun, d.xz) * inversesqrt(max(dot(to_sun, to_sun) * dot(d.xz, d.xz), 1e-12));
    vec2 at = sqrt(max(vec2(0.5 - 0.5 * cosine, d.y), 0.0));
    vec2 size = vec2(textureSize(sky_view, 0));
    vec3 above = environment.zenith.rgb * textureLod(sky_view, (at * (size - 1.0) + 0.5) / size, 0.0).rgb;
    const float kHorizonBlend = 60.0;  // distant ground takes the color of the sky above it
    return mix(environment.ground.rgb, above, exp2(kHorizonBlend * min(d.y, 0.0)));
}
#endif

// The color between horizon and zenith falls off like haze, fast near the horizon; distant ground takes the color of
// the haze. Shape by eye.
vec3 gradient_sky(vec3 d) {
    vec3 above = mix(environment.zenith.rgb, environment.horizon.rgb, exp2(-4.5 * max(d.y, 0.0)));
    vec3 below = mix(environment.ground.rgb, 0.8 * environment.horizon.rgb, exp2(12.0 * min(d.y, 0.0)));
    return mix(below, above, smoothstep(-0.015, 0.015, d.y));
}

// A dark room whose wall is brightest behind the object.
vec3 studio_backdrop(vec3 d) {
    float wall = 1.0 - abs(d.y - 0.05);
    float carpet = smoothstep(-0.1, -0.9, d.y);
    return environment.horizon.w * (mix(0.030, 0.175, wall * wall * wall) * vec3(0.96, 0.98, 1.04) + 0.04 * carpet);
}

vec3 studio_lamps(vec3 d) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < kStudioLamps; ++i) {
        StudioLamp lamp = environment.lamps[i];
        float t = dot(d, lamp.center.xyz);
        vec2 at = abs(vec2(dot(d, lamp.u.xyz), dot(d, lamp.v.xyz))) / max(t, 1e-4);
        vec2 inside = 1.0 - smoothstep(vec2(1.0 - lamp.center.w), vec2(1.0 + lamp.center.w), at);
        sum += t > 0.0 ? lamp.color.rgb * (inside.x * inside.y) : vec3(0.0);
    }
    return sum;
}

// Radiance that lights the scene: without the sun, which is a separate light.
vec3 sky_radiance(vec3 d) {
#if SKY_KIND == 0
    return gradient_sky(d);
#elif SKY_KIND == 1
    return studio_backdrop(d) + studio_lamps(d);
#elif SKY_KIND == 3
    return textureLod(sky_cube, d, 0.0).rgb;
#elif SKY_KIND == 4
    return atmosphere_sky(d);
#else
    return environment.zenith.rgb;
#endif
}

const float kSunCosine = 0.99995;        // of the disc's radius, 0.57 degrees: twice the real one looks better
const float kSunSoftness = 0.00001;
const float kSunGlow = 0.06;             // radiance of the glow around it per lux, by eye
const float kMaxSunRadiance = 20000.0;   // half floats end at 65504

// Visible background: with the sun and, for a gradient, its glow, but without the studio's lamps.
vec3 sky_background(vec3 d) {
#if SKY_KIND == 0 || SKY_KIND == 4
    float c = dot(d, environment.sun_direction.xyz);
    float solid_angle = 2.0 * 3.14159265 * (1.0 - kSunCosine);
    float disc = smoothstep(kSunCosine - kSunSoftness, kSunCosine + kSunSoftness, c) / solid_angle;
    float glow = SKY_KIND == 4 ? 0.0 : kSunGlow * (pow(max(c, 0.0), 24.0) * 0.3 + pow(max(c, 0.0), 600.0));
    float above = smoothstep(-0.02, 0.02, d.y);
    vec3 sun = environment.sun_color.rgb * above * (disc + glow);
    return sky_radiance(d) + min(sun, vec3(kMaxSunRadiance));
#elif SKY_KIND == 1
    return studio_backdrop(d);
#else
    return sky_radiance(d);
#endif
}
#endif
