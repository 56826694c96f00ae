#include "bench/characters/scalar_ik.h"

#include <algorithm>
#include <cmath>

namespace limn::bench {
namespace {

// Called, they would pass vectors through memory, which takes longer than what they do.
#define LIMN_BY_HAND [[gnu::always_inline]] inline

struct P3 {
    float x;
    float y;
    float z;
};
LIMN_BY_HAND P3 operator+(P3 a, P3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
LIMN_BY_HAND P3 operator-(P3 a, P3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
LIMN_BY_HAND P3 operator*(float s, P3 a) {
    return {s * a.x, s * a.y, s * a.z};
}
LIMN_BY_HAND float dot(P3 a, P3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LIMN_BY_HAND P3 cross(P3 a, P3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
LIMN_BY_HAND P3 point(const float* p, std::size_t i) {
    return {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
}
LIMN_BY_HAND void put(P3 v, float* p, std::size_t i) {
    p[3 * i] = v.x;
    p[3 * i + 1] = v.y;
    p[3 * i + 2] = v.z;
}

struct Q4 {
    P3 v;
    float w;
};
LIMN_BY_HAND Q4 arc(P3 a, P3 b) {
    const float w = std::sqrt(dot(a, a) * dot(b, b)) + dot(a, b);
    const P3 v = cross(a, b);
    const float length2 = w * w + dot(v, v);
    if (length2 < 1e-24f) {
        return {{1, 0, 0}, 0};
    }
    const float scale = 1 / std::sqrt(length2);
    return {scale * v, scale * w};
}
LIMN_BY_HAND P3 rotate(Q4 q, P3 b) {
    const P3 c = cross(q.v, b);
    return b + 2.0f * (q.w * c + cross(q.v, c));
}
LIMN_BY_HAND void put(Q4 q, float* rotations, std::size_t i) {
    rotations[4 * i] = q.v.x;
    rotations[4 * i + 1] = q.v.y;
    rotations[4 * i + 2] = q.v.z;
    rotations[4 * i + 3] = q.w;
}

}  // namespace

void two_links_by_hand(const float* points, std::size_t count, float* rotations) {
    for (std::size_t i = 0; i < count; ++i) {
        const P3 root = point(points, 5 * i);
        const P3 middle = point(points, 5 * i + 1);
        const P3 upper = middle - root;
        const P3 lower = point(points, 5 * i + 2) - middle;
        const P3 way = point(points, 5 * i + 3) - root;
        const P3 pole = point(points, 5 * i + 4);
        const float upper2 = dot(upper, upper);
        const float lower2 = dot(lower, lower);
        const float upper1 = std::sqrt(upper2);
        const float lower1 = std::sqrt(lower2);
        const float far = std::sqrt(dot(way, way));
        const P3 n = far > 1e-12f ? (1 / far) * way : P3{0, 0, 1};
        const float distance = std::max(std::min(far, upper1 + lower1), std::abs(upper1 - lower1));
        const float along = std::clamp(
            (upper2 - lower2 + distance * distance) / std::max(2 * distance, 1e-12f), -upper1,
            upper1);
        const float radius = std::sqrt(std::max(upper2 - along * along, 0.0f));
        P3 beside = pole - dot(pole, n) * n;
        if (dot(beside, beside) < 1e-12f) {
            beside = {n.y, n.z, n.x};
        }
        const P3 elbow = along * n + (radius / std::sqrt(dot(beside, beside))) * beside;
        const Q4 first = arc(upper, elbow);
        put(first, rotations, 2 * i);
        put(arc(rotate(first, lower), distance * n - elbow), rotations, 2 * i + 1);
    }
}

void aim_by_hand(const float* forward, const float* wanted, std::size_t count, float* rotations) {
    for (std::size_t i = 0; i < count; ++i) {
        put(arc(point(forward, i), point(wanted, i)), rotations, i);
    }
}

void dls_by_hand(
    float* points, const float* goals, std::size_t count, int links, int iterations,
    float damping) {
    for (std::size_t i = 0; i < count; ++i) {
        float* const p = points + i * 3 * (links + 1);
        const P3 goal = point(goals, i);
        float length = 0;
        for (int k = 0; k < links; ++k) {
            const P3 bone = point(p, k + 1) - point(p, k);
            length += std::sqrt(dot(bone, bone));
        }
        const float lambda2 = damping * damping * length * length;
        for (int iteration = 0; iteration < iterations; ++iteration) {
            const P3 tip = point(p, links);
            float xx = lambda2;
            float yy = lambda2;
            float zz = lambda2;
            float xy = 0;
            float xz = 0;
            float yz = 0;
            for (int k = 0; k < links; ++k) {
                const P3 r = tip - point(p, k);
                xx += r.y * r.y + r.z * r.z;
                yy += r.x * r.x + r.z * r.z;
                zz += r.x * r.x + r.y * r.y;
                xy -= r.x * r.y;
                xz -= r.x * r.z;
                yz -= r.y * r.z;
            }
            const P3 left = goal - tip;
            const P3 a = {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy};
            const P3 b = {a.y, xx * zz - xz * xz, xy * xz - xx * yz};
            const P3 c = {a.z, b.z, xx * yy - xy * xy};
            const float reciprocal = 0.5f / (xx * a.x + xy * a.y + xz * a.z);
            const P3 y = reciprocal * P3{dot(a, left), dot(b, left), dot(c, left)};
            P3 turn = {0, 0, 0};
            P3 end = point(p, 0);
            P3 before = end;
            for (int k = 0; k < links; ++k) {
                turn = turn + cross(tip - before, y);
                const P3 next = point(p, k + 1);
                const P3 bone = next - before;
                before = next;
                const P3 once = cross(turn, bone);
                end = end + bone + (2 / (1 + dot(turn, turn))) * (once + cross(turn, once));
                put(end, p, k + 1);
            }
        }
    }
}

void fabrik_by_hand(
    float* points, const float* goals, std::size_t count, int links, int iterations) {
    float lengths[16];
    for (std::size_t i = 0; i < count; ++i) {
        float* const p = points + i * 3 * (links + 1);
        for (int k = 0; k < links; ++k) {
            const P3 bone = point(p, k + 1) - point(p, k);
            lengths[k] = std::sqrt(dot(bone, bone));
        }
        const P3 root = point(p, 0);
        for (int iteration = 0; iteration < iterations; ++iteration) {
            put(point(goals, i), p, links);
            for (int k = links - 1; k >= 0; --k) {
                const P3 way = point(p, k) - point(p, k + 1);
                const float size = std::max(std::sqrt(dot(way, way)), 1e-12f);
                put(point(p, k + 1) + (lengths[k] / size) * way, p, k);
            }
            put(root, p, 0);
            for (int k = 0; k < links; ++k) {
                const P3 way = point(p, k + 1) - point(p, k);
                const float size = std::max(std::sqrt(dot(way, way)), 1e-12f);
                put(point(p, k) + (lengths[k] / size) * way, p, k + 1);
            }
        }
    }
}

void ccd_by_hand(float* points, const float* goals, std::size_t count, int links, int iterations) {
    for (std::size_t i = 0; i < count; ++i) {
        float* const p = points + i * 3 * (links + 1);
        const P3 goal = point(goals, i);
        for (int iteration = 0; iteration < iterations; ++iteration) {
            for (int k = links - 1; k >= 0; --k) {
                const P3 joint = point(p, k);
                const Q4 turn = arc(point(p, links) - joint, goal - joint);
                for (int below = k + 1; below <= links; ++below) {
                    put(joint + rotate(turn, point(p, below) - joint), p, below);
                }
            }
        }
    }
}

}  // namespace limn::bench
