#include "ecs/components/deformers.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: face.ffd, face.pull, face.waters-muscle

namespace limn {

namespace {

/// Step of the finite differences for normals, relative to the smallest control.
constexpr float kStep = 1.0f / 256.0f;
constexpr float kMinSize = 1e-6f;  ///< of a control [m]

bool is_finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

class Packer {
  public:
    void add(const LinearMuscle& muscle) {
        const Vec3 axis = muscle.insertion - muscle.attachment;
        const float length = glm::length(axis);
        const bool has_extent = length > kMinSize && muscle.full > kMinSize
                                && muscle.reach > muscle.full && muscle.angle > 0.0f;
        if (!has_extent || !is_finite(axis) || !std::isfinite(muscle.reach)
            || !std::isfinite(muscle.contraction)) {
            return;
        }
        begin(muscle.full);
        packed_.insert(
            packed_.end(),
            {Vec4(kMuscle, muscle.contraction * length, muscle.angle, 0),
             Vec4(muscle.attachment, muscle.full), Vec4(axis / length, muscle.reach)});
    }

    void add(const SphincterMuscle& muscle) {
        const float length2 = std::max(glm::dot(muscle.right, muscle.right), kMinSize * kMinSize);
        const Vec3 up = muscle.up - glm::dot(muscle.up, muscle.right) / length2 * muscle.right;
        const Vec3 normal = glm::cross(muscle.right, up);
        const float area = glm::length(normal);
        if (!(area > kMinSize * kMinSize) || !(muscle.depth > kMinSize) || !is_finite(normal)
            || !is_finite(muscle.center) || !std::isfinite(muscle.contraction)) {
            return;
        }
        const Vec3 deep = normal / area;
        begin(std::min({glm::length(muscle.right), glm::length(up), muscle.depth}));
        packed_.insert(
            packed_.end(),
            {Vec4(kSphincter, muscle.contraction, 0, 0), Vec4(muscle.center, 0),
             Vec4(glm::cross(up, deep) / area, 0), Vec4(glm::cross(deep, muscle.right) / area, 0),
             Vec4(deep / muscle.depth, muscle.depth)});
    }

    void add(const Lattice& lattice) {
        const Vec3 across = glm::cross(lattice.v, lattice.w);
        const float volume = glm::dot(across, lattice.u);
        if (!(std::abs(volume) > kMinSize * kMinSize * kMinSize) || !is_finite(across)
            || !is_finite(lattice.u) || !is_finite(lattice.origin)) {
            return;
        }
        begin(std::min({glm::length(lattice.u), glm::length(lattice.v), glm::length(lattice.w)}));
        packed_.insert(
            packed_.end(),
            {Vec4(kLattice, 0, 0, 0), Vec4(lattice.origin, 0), Vec4(across / volume, 0),
             Vec4(glm::cross(lattice.w, lattice.u) / volume, 0),
             Vec4(glm::cross(lattice.u, lattice.v) / volume, 0)});
        for (std::size_t i = 0; i < kLatticePoints; ++i) {
            const bool is_given = i < lattice.offsets.size() && is_finite(lattice.offsets[i]);
            packed_.emplace_back(is_given ? lattice.offsets[i] : Vec3(0), 0);
        }
    }

    void add(const Tug& tug) {
        const float inverse_square = 1.0f / square(tug.radius);
        if (tug.offset == Vec3(0) || !(tug.radius > kMinSize) || !std::isfinite(inverse_square)
            || !is_finite(tug.offset) || !is_finite(tug.at)) {
            return;
        }
        begin(tug.radius);
        packed_.emplace_back(kTug, tug.offset.x, tug.offset.y, tug.offset.z);
        packed_.emplace_back(tug.at, inverse_square);
    }

    std::vector<Vec4> finish() {
        if (records_ == 0) {
            return {};
        }
        packed_[0] = Vec4(records_, kStep * smallest_, 0, 0);
        return std::move(packed_);
    }

  private:
    void begin(float size) {
        smallest_ = records_ == 0 ? size : std::min(smallest_, size);
        ++records_;
    }

    std::vector<Vec4> packed_{Vec4(0)};
    int records_ = 0;
    float smallest_ = 0.0f;
};

}  // namespace

std::vector<Vec4> pack_deformers(const Deformers& deformers, std::span<const Tug> more) {
    Packer packer;
    for (const LinearMuscle& muscle : deformers.muscles) {
        packer.add(muscle);
    }
    for (const SphincterMuscle& muscle : deformers.sphincters) {
        packer.add(muscle);
    }
    for (const Lattice& lattice : deformers.lattices) {
        packer.add(lattice);
    }
    for (const Tug& tug : deformers.tugs) {
        packer.add(tug);
    }
    for (const Tug& tug : more) {
        packer.add(tug);
    }
    return packer.finish();
}

float max_displacement(std::span<const Vec4> packed) {
    float most = 0.0f;
    for (std::size_t i = 1; i < packed.size();) {
        if (packed[i].x == kMuscle) {
            most += std::abs(packed[i].y);
            i += kMuscleTexels;
        } else if (packed[i].x == kSphincter) {
            // Within the ellipse k f |center - p| is at most k times a quarter of the semi-axis.
            const float axis = std::max(
                1.0f / glm::length(Vec3(packed[i + 2])), 1.0f / glm::length(Vec3(packed[i + 3])));
            most += 0.25f * std::abs(packed[i].y) * axis;
            i += kSphincterTexels;
        } else if (packed[i].x == kTug) {
            most += glm::length(Vec3(packed[i].y, packed[i].z, packed[i].w));
            i += kTugTexels;
        } else {
            float farthest = 0.0f;
            for (std::size_t k = 0; k < kLatticePoints; ++k) {
                farthest = std::max(farthest, glm::length(Vec3(packed[i + 5 + k])));
            }
            most += farthest;
            i += kLatticeTexels;
        }
    }
    return most;
}

}  // namespace limn
