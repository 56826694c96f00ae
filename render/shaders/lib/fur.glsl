// Strands of fur, cut by a plane across them. Roots are in jittered cells of the plane, one each; the cross-section of
// a strand is a disc whose area falls linearly to 0 at its tip. So at the height t, 0 .. 1, strands of length 1 that do
// not overlap cover
//
//     pi radius^2 (1 - t)
//
// of the plane. Lengths and directions vary from strand to strand and smoothly from tuft to tuft. Cells smaller than a
// pixel are joined, four to one, until they are larger: strands get thicker and fewer and cover the same.
// Shells and fins: Lengyel et al., "Real-Time Fur over Arbitrary Surfaces", 2001.
// Techniques: shade.fur

const float kStrandsAcrossTuft = 7.0;  // by eye
const float kFinFade = 0.6;            // by eye
const uint kFurSeed = 0x667572u;

struct FurPoint {
    bool covered;
    vec4 random;  // of the strand; w is independent of its shape
};

vec4 fur_random(ivec2 cell, uint seed) {
    uint h = seed * 0x9e3779b9u ^ uint(cell.x) * 0x85ebca6bu;
    h = (h ^ (h >> 15)) * 0xc2b2ae35u ^ uint(cell.y) * 0x27d4eb2fu;
    h = (h ^ (h >> 13)) * 0x85ebca6bu;
    h = (h ^ (h >> 16)) * 0xc2b2ae35u;
    h = h ^ (h >> 16);
    return vec4(uvec4(h) >> uvec4(0u, 8u, 16u, 24u) & 255u) * (1.0 / 255.0);
}

// Three smooth functions in -1 .. 1.
vec3 fur_tuft(vec2 at) {
    ivec2 cell = ivec2(floor(at));
    vec2 f = at - floor(at);
    f = f * f * (3.0 - 2.0 * f);
    vec3 low = mix(fur_random(cell, 1u).xyz, fur_random(cell + ivec2(1, 0), 1u).xyz, f.x);
    vec3 high = mix(fur_random(cell + ivec2(0, 1), 1u).xyz, fur_random(cell + ivec2(1, 1), 1u).xyz, f.x);
    return 2.0 * mix(low, high, f.y) - 1.0;
}

// `at`: in cells, on the surface; `height`: 0 at the skin, 1 at the tips; `shape`: FurRecord::shape.
FurPoint fur_point(vec2 at, float height, vec4 shape) {
    vec3 tuft = fur_tuft(at / kStrandsAcrossTuft);
    at -= height * height * shape.z * tuft.xy;
    // Centers are at most 0.25 from those of their cells: strands of radius 0.7 reach from the four nearest at most.
    ivec2 first = ivec2(floor(at - 0.5));
    FurPoint point = FurPoint(false, vec4(0.5));
    float nearest = 1.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 cell = first + ivec2(i & 1, i >> 1);
        vec4 random = fur_random(cell, kFurSeed);
        vec2 from_center = at - (vec2(cell) + 0.25 + 0.5 * random.xy);
        float rank = clamp(0.5 * (random.z + 0.5 + 0.5 * tuft.z), 0.0, 1.0);
        float left = 1.0 - height / mix(shape.y, 1.0, rank);
        float distance2 = dot(from_center, from_center) / max(shape.x * shape.x * left, 1e-12);
        if (left > 0.0 && distance2 < nearest) {
            nearest = distance2;
            point = FurPoint(true, random);
        }
    }
    return point;
}

// The same of a fin, a plane along strands: `at` along its edge. `facing`: cosine of the surface's normal to the viewer;
// strands vanish one by one as it rises, since shells show them.
FurPoint fin_point(float at, float height, vec4 shape, float facing) {
    FurPoint point = FurPoint(false, vec4(0.5));
    float nearest = 1.0;
    int first = int(floor(at - 0.5));
    for (int i = 0; i < 2; ++i) {
        vec4 random = fur_random(ivec2(first + i, 0), kFurSeed);
        float from_center = at - (float(first + i) + 0.25 + 0.5 * random.x);
        float left = 1.0 - height / mix(shape.y, 1.0, random.z);
        float distance2 = from_center * from_center / max(shape.x * shape.x * left, 1e-12);
        bool shown = abs(facing) < kFinFade * random.y;
        if (left > 0.0 && shown && distance2 < nearest) {
            nearest = distance2;
            point = FurPoint(true, random);
        }
    }
    return point;
}

// The factor on coordinates in cells that joins cells until a pixel, of this size [cells], is one or less.
float fur_scale(vec2 per_pixel) {
    return exp2(-ceil(max(log2(max(per_pixel.x, per_pixel.y)), 0.0)));
}
