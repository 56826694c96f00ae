#include "content/bake/ray_caster.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <embree3/rtcore.h>
#include <utility>

namespace limn {

namespace {

/// Closed by the last user; one for all casters.
struct EmbreeDevice {
    RTCDevice device = nullptr;

    EmbreeDevice() {
        const char* const config = __builtin_cpu_supports("avx") ? "isa=avx" : "";
        device = rtcNewDevice(config);
        LIMN_CHECK_NOTE(device != nullptr, "Embree could not be initialized");
    }
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;
    ~EmbreeDevice() { rtcReleaseDevice(device); }
};

RTCDevice embree_device() {
    static const EmbreeDevice device;
    return device.device;
}

struct CornerPoints {
    glm::dvec3 p[3];
};

/// Where a ray that meets the triangle does so (Moeller and Trumbore 1997). On its edges, and for
/// rays in its plane, the weights are clamped to the triangle.
RayHit
hit_of(const MeshRay& ray, const CornerPoints& corners, std::uint32_t triangle, float rough_t) {
    const glm::dvec3 origin(ray.origin);
    const glm::dvec3 direction(ray.direction);
    const glm::dvec3 a = corners.p[1] - corners.p[0];
    const glm::dvec3 b = corners.p[2] - corners.p[0];
    const glm::dvec3 h = glm::cross(direction, b);
    const double determinant = glm::dot(a, h);
    RayHit hit = {.t = rough_t, .triangle = triangle, .front = determinant > 0};
    if (determinant == 0) {
        return hit;
    }
    const glm::dvec3 s = origin - corners.p[0];
    const glm::dvec3 q = glm::cross(s, a);
    const double t = glm::dot(b, q) / determinant;
    hit.t = std::isfinite(t) ? static_cast<float>(t) : rough_t;
    glm::dvec3 weights;
    weights.y = std::clamp(glm::dot(s, h) / determinant, 0.0, 1.0);
    weights.z = std::clamp(glm::dot(direction, q) / determinant, 0.0, 1.0);
    weights.x = std::max(1.0 - weights.y - weights.z, 0.0);
    hit.weights = Vec3(weights / (weights.x + weights.y + weights.z));
    return hit;
}

/// The point of a triangle nearest to `p`, by its barycentric coordinates (Ericson 2005, 5.1.5).
glm::dvec3 nearest_weights(const glm::dvec3& p, const CornerPoints& c) {
    const glm::dvec3 ab = c.p[1] - c.p[0];
    const glm::dvec3 ac = c.p[2] - c.p[0];
    const glm::dvec3 ap = p - c.p[0];
    const double d1 = glm::dot(ab, ap);
    const double d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) {
        return {1, 0, 0};
    }
    const glm::dvec3 bp = p - c.p[1];
    const double d3 = glm::dot(ab, bp);
    const double d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) {
        return {0, 1, 0};
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double v = d1 / (d1 - d3);
        return {1 - v, v, 0};
    }
    const glm::dvec3 cp = p - c.p[2];
    const double d5 = glm::dot(ab, cp);
    const double d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) {
        return {0, 0, 1};
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double w = d2 / (d2 - d6);
        return {1 - w, 0, w};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

bool comes_before(const RayHit& a, const RayHit& b) {
    return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
}

}  // namespace

struct RayCaster::State {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    Bounds bounds;
    float size = 0;  ///< largest absolute coordinate
    RTCScene scene = nullptr;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (scene != nullptr) {
            rtcReleaseScene(scene);
        }
    }

    [[nodiscard]] CornerPoints corners(std::uint32_t triangle) const {
        const std::size_t first = std::size_t{3} * triangle;
        return {
            {glm::dvec3(positions[indices[first]]), glm::dvec3(positions[indices[first + 1]]),
             glm::dvec3(positions[indices[first + 2]])}};
    }

    void build();
    [[nodiscard]] RTCRayHit trace(RTCIntersectContext& context, const MeshRay& ray) const;
};

namespace {

/// Rejects each hit after recording it, so that Embree goes on.
struct HitCollector {
    RTCIntersectContext context;  // first: Embree passes its address
    const MeshRay* ray = nullptr;
    std::vector<RayHit>* hits = nullptr;
    const Vec3* positions = nullptr;
    const std::uint32_t* indices = nullptr;

    static void collect(const RTCFilterFunctionNArguments* arguments) {
        if (arguments->valid[0] == 0) {
            return;
        }
        const auto& self = *reinterpret_cast<const HitCollector*>(arguments->context);
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
        const float rough_t = RTCRayN_tfar(arguments->ray, arguments->N, 0);
        CornerPoints corners;
        for (std::size_t k = 0; k < 3; ++k) {
            corners.p[k] = glm::dvec3(self.positions[self.indices[std::size_t{3} * triangle + k]]);
        }
        self.hits->push_back(hit_of(*self.ray, corners, triangle, rough_t));
        arguments->valid[0] = 0;
    }
};

struct PointSearch {
    glm::dvec3 point;
    const Vec3* positions = nullptr;
    const std::uint32_t* indices = nullptr;
    double best2 = 0;
    bool found = false;
    std::uint32_t triangle = 0;
    glm::dvec3 weights = {1, 0, 0};

    static bool visit(RTCPointQueryFunctionArguments* arguments) {
        PointSearch& self = *static_cast<PointSearch*>(arguments->userPtr);
        CornerPoints c;
        for (std::size_t k = 0; k < 3; ++k) {
            c.p[k] =
                glm::dvec3(self.positions[self.indices[std::size_t{3} * arguments->primID + k]]);
        }
        const glm::dvec3 weights = nearest_weights(self.point, c);
        const glm::dvec3 d =
            weights.x * c.p[0] + weights.y * c.p[1] + weights.z * c.p[2] - self.point;
        const double distance2 = glm::dot(d, d);
        const bool better =
            distance2 < self.best2
            || (distance2 == self.best2 && (!self.found || arguments->primID < self.triangle));
        if (!better) {
            return false;
        }
        self.best2 = distance2;
        self.found = true;
        self.triangle = arguments->primID;
        self.weights = weights;
        // A little more, so that a triangle at the same distance is still visited.
        arguments->query->radius = static_cast<float>(std::sqrt(distance2) * (1 + 1e-6));
        return true;
    }
};

}  // namespace

void RayCaster::State::build() {
    scene = rtcNewScene(embree_device());
    rtcSetSceneFlags(
        scene,
        static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    const std::size_t count = indices.size() / 3;
    if (count > 0) {
        RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
        void* const vertices = rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), positions.size());
        void* const triangles = rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count);
        LIMN_CHECK(vertices != nullptr && triangles != nullptr);
        std::memcpy(vertices, positions.data(), positions.size() * sizeof(Vec3));
        std::memcpy(triangles, indices.data(), 3 * count * sizeof(std::uint32_t));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
}

RTCRayHit RayCaster::State::trace(RTCIntersectContext& context, const MeshRay& ray) const {
    RTCRayHit query = {};
    query.ray.org_x = ray.origin.x;
    query.ray.org_y = ray.origin.y;
    query.ray.org_z = ray.origin.z;
    query.ray.dir_x = ray.direction.x;
    query.ray.dir_y = ray.direction.y;
    query.ray.dir_z = ray.direction.z;
    query.ray.tnear = std::max(ray.min_t, 0.0f);
    query.ray.tfar = ray.max_t;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (is_finite(ray.origin) && is_finite(ray.direction) && ray.min_t <= ray.max_t) {
        rtcIntersect1(scene, &context, &query);
    }
    return query;
}

RayCaster::RayCaster(std::span<const Vec3> positions, std::span<const std::uint32_t> indices)
    : state_(std::make_unique<State>()) {
    state_->positions.assign(positions.begin(), positions.end());
    state_->indices.assign(indices.begin(), indices.end());
    state_->indices.resize(indices.size() / 3 * 3);
    for (const std::uint32_t index : state_->indices) {
        LIMN_CHECK(index < positions.size());
        if (is_finite(positions[index])) {
            grow(state_->bounds, positions[index]);
        }
    }
    if (!is_empty(state_->bounds)) {
        for (const Vec3& corner : {state_->bounds.min, state_->bounds.max}) {
            for (int axis = 0; axis < 3; ++axis) {
                state_->size = std::max(state_->size, std::abs(corner[axis]));
            }
        }
    }
    state_->build();
}

RayCaster::RayCaster(RayCaster&& other) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&& other) noexcept = default;
RayCaster::~RayCaster() = default;

const Bounds& RayCaster::bounds() const {
    return state_->bounds;
}

std::optional<RayHit> RayCaster::nearest(const MeshRay& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const RTCRayHit found = state_->trace(context, ray);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return std::nullopt;
    }
    const float t = found.ray.tfar;
    // Embree's t has the rounding errors of floats; within those, the exact t decides.
    const float slack = 1e-5f * t + 1e-6f * state_->size / glm::length(ray.direction);
    MeshRay near = ray;
    near.min_t = std::max(t - slack, ray.min_t);
    near.max_t = std::min(t + slack, ray.max_t);
    thread_local std::vector<RayHit> hits;
    find_all(near, hits);
    return hits.empty() ? hit_of(ray, state_->corners(found.hit.primID), found.hit.primID, t)
                        : hits.front();
}

void RayCaster::find_all(const MeshRay& ray, std::vector<RayHit>& hits) const {
    hits.clear();
    HitCollector collector;
    rtcInitIntersectContext(&collector.context);
    collector.context.filter = HitCollector::collect;
    collector.ray = &ray;
    collector.hits = &hits;
    collector.positions = state_->positions.data();
    collector.indices = state_->indices.data();
    (void)state_->trace(collector.context, ray);
    std::sort(hits.begin(), hits.end(), comes_before);
}

std::optional<RayHit> RayCaster::nearest_point(const Vec3& point, float max_distance) const {
    PointSearch search;
    search.point = glm::dvec3(point);
    search.positions = state_->positions.data();
    search.indices = state_->indices.data();
    search.best2 = square(static_cast<double>(max_distance));
    RTCPointQuery query = {};
    query.x = point.x;
    query.y = point.y;
    query.z = point.z;
    query.radius = max_distance;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    if (is_finite(point)) {
        rtcPointQuery(state_->scene, &query, &context, PointSearch::visit, &search);
    }
    if (!search.found) {
        return std::nullopt;
    }
    return RayHit{
        .t = static_cast<float>(std::sqrt(search.best2)),
        .triangle = search.triangle,
        .weights = Vec3(search.weights)};
}

}  // namespace limn
