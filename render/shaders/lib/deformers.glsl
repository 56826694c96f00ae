// Muscles, lattices and tugs that move vertices: ecs/components/deformers.h has the layout of the packed controls,
// systems/animation/deformer_kernels.cpp the same on the CPU. Needs `samplerBuffer controls`.
// Techniques: face.ffd, face.pull, face.waters-muscle

const float kMuscle = 1.0;
const float kSphincter = 2.0;
const float kLattice = 3.0;
const float kTug = 4.0;
const int kMuscleTexels = 3;
const int kSphincterTexels = 5;
const int kLatticeTexels = 69;
const int kTugTexels = 2;
const float kHalfPi = 1.57079632679;

// Sum of the pulls of muscles, and the largest distance to a point that they pull toward.
struct Pull {
    vec3 sum;
    float farthest;
};

// For 0 <= x <= 1 within 2e-8: Abramowitz and Stegun 4.4.46. GLSL's own may be off by 1e-4.
float arc_cosine(float x) {
    float sum = -0.0012624911;
    sum = sum * x + 0.0066700901;
    sum = sum * x - 0.0170881256;
    sum = sum * x + 0.0308918810;
    sum = sum * x - 0.0501743046;
    sum = sum * x + 0.0889789874;
    sum = sum * x - 0.2145988016;
    sum = sum * x + 1.5707963050;
    return sqrt(1.0 - x) * sum;
}

void add_muscle(int record, vec3 p, inout Pull pull) {
    vec4 strength = texelFetch(controls, record);        // kind, contraction * length, angle
    vec4 attachment = texelFetch(controls, record + 1);  // w: distance of the strongest pull
    vec4 axis = texelFetch(controls, record + 2);        // w: radius
    vec3 to_attachment = attachment.xyz - p;
    float distance = length(to_attachment);
    if (!(distance > 0.0) || distance >= axis.w) {
        return;
    }
    float cosine = clamp(-dot(to_attachment, axis.xyz) / distance, 0.0, 1.0);
    float off_axis = arc_cosine(cosine) / strength.z;
    if (off_axis >= 1.0) {
        return;
    }
    float beyond = max((distance - attachment.w) / (axis.w - attachment.w), 0.0);
    float rise = sin(kHalfPi * min(distance / attachment.w, 1.0));
    float fall = cos(kHalfPi * beyond) * cos(kHalfPi * off_axis);
    float strength_here = rise * fall * fall;
    pull.sum += (strength.y * strength_here / distance) * to_attachment;
    pull.farthest = max(pull.farthest, distance);
}

void add_sphincter(int record, vec3 p, inout Pull pull) {
    float contraction = texelFetch(controls, record).y;
    vec3 to_center = texelFetch(controls, record + 1).xyz - p;
    vec4 depth = texelFetch(controls, record + 4);
    vec3 q = vec3(
        dot(texelFetch(controls, record + 2).xyz, to_center),
        dot(texelFetch(controls, record + 3).xyz, to_center),
        dot(depth.xyz, to_center));
    float strength_here = 1.0 - length(q);
    if (strength_here <= 0.0) {
        return;
    }
    vec3 deep = depth.w * depth.xyz;
    vec3 inward = to_center - dot(to_center, deep) * deep;
    pull.sum += contraction * strength_here * inward;
    pull.farthest = max(pull.farthest, length(inward));
}

vec4 bernstein(float t) {
    float s = 1.0 - t;
    return vec4(s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t);
}

vec3 through_lattice(int record, vec3 p) {
    vec3 from_origin = p - texelFetch(controls, record + 1).xyz;
    vec3 q = vec3(
        dot(texelFetch(controls, record + 2).xyz, from_origin),
        dot(texelFetch(controls, record + 3).xyz, from_origin),
        dot(texelFetch(controls, record + 4).xyz, from_origin));
    if (any(lessThan(q, vec3(0.0))) || any(greaterThan(q, vec3(1.0)))) {
        return p;
    }
    vec4 bu = bernstein(q.x);
    vec4 bv = bernstein(q.y);
    vec4 bw = bernstein(q.z);
    int point = record + 5;
    for (int k = 0; k < 4; ++k) {
        for (int j = 0; j < 4; ++j) {
            for (int i = 0; i < 4; ++i) {
                p += bu[i] * bv[j] * bw[k] * texelFetch(controls, point).xyz;
                ++point;
            }
        }
    }
    return p;
}

vec3 through_tug(int record, vec3 p) {
    vec3 offset = texelFetch(controls, record).yzw;
    vec4 at = texelFetch(controls, record + 1);  // w: 1 / radius^2
    vec3 from = p - at.xyz;
    float left = 1.0 - at.w * dot(from, from);
    return left > 0.0 ? p + left * left * left * offset : p;
}

// Deforms a point by the list of controls at `first`.
vec3 deform_point(int first, vec3 p) {
    int count = int(texelFetch(controls, first).x);
    int record = first + 1;
    Pull pull = Pull(vec3(0.0), 0.0);
    int i = 0;
    for (; i < count; ++i) {
        float kind = texelFetch(controls, record).x;
        if (kind == kMuscle) {
            add_muscle(record, p, pull);
            record += kMuscleTexels;
        } else if (kind == kSphincter) {
            add_sphincter(record, p, pull);
            record += kSphincterTexels;
        } else {
            break;
        }
    }
    float size = length(pull.sum);
    p += size > pull.farthest ? (pull.farthest / size) * pull.sum : pull.sum;
    for (; i < count; ++i) {
        if (texelFetch(controls, record).x == kLattice) {
            p = through_lattice(record, p);
            record += kLatticeTexels;
        } else {
            p = through_tug(record, p);
            record += kTugTexels;
        }
    }
    return p;
}

// Deforms a short vector at `p`, by central differences.
vec3 deform_vector(int first, vec3 p, vec3 unit) {
    float offset = texelFetch(controls, first).y;
    return (deform_point(first, p + offset * unit) - deform_point(first, p - offset * unit)) / (2.0 * offset);
}
