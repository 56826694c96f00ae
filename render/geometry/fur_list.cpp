#include "render/geometry/fur_list.h"

#include "ecs/base/log.h"
#include "ecs/components/fur.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

// Techniques: shade.fur

namespace limn {
namespace {

constexpr float kMinStretch = 1e-6f;  ///< of texture coordinates [m]

layout::FurRecord make_fur_record(const Fur& fur, const FurChart& chart) {
    const Vec2 cells = fur.density * chart.scale;
    return {
        .lean = Vec4(fur.comb, fur.droop),
        .strands = {fur.length, cells.x, cells.y, chart.second ? 1.0f : 0.0f},
        .shape = {0.5f * fur.thickness, fur.shortest, fur.wave, fur.unruly},
        .color = Vec4(fur.tip, fur.root),
        .noise = {fur.variation, 0, 0, 0}};
}

}  // namespace

float shell_offset(const Fur& fur, std::int32_t i) {
    return fur.length * static_cast<float>(i) / static_cast<float>(fur.shells);
}

float fur_lean(const Fur& fur) {
    return glm::length(fur.comb) + fur.droop;
}

FurChart find_fur_chart(const MeshData& mesh) {
    FurChart chart;
    chart.second = mesh.uvs1.size() == mesh.positions.size();
    const std::vector<Vec2>& uvs = chart.second ? mesh.uvs1 : mesh.uvs;
    double area = 0;
    double u = 0;
    double v = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size() && !uvs.empty(); i += 3) {
        const std::uint32_t* const corner = &mesh.indices[i];
        const Vec3 p = mesh.positions[corner[1]] - mesh.positions[corner[0]];
        const Vec3 q = mesh.positions[corner[2]] - mesh.positions[corner[0]];
        const Vec2 s = uvs[corner[1]] - uvs[corner[0]];
        const Vec2 t = uvs[corner[2]] - uvs[corner[0]];
        const float det = s.x * t.y - s.y * t.x;
        const float twice = glm::length(glm::cross(p, q));
        if (std::abs(det) > 1e-12f && twice > 0) {
            area += static_cast<double>(twice);
            u += static_cast<double>(twice * glm::length(t.y * p - s.y * q) / std::abs(det));
            v += static_cast<double>(twice * glm::length(s.x * q - t.x * p) / std::abs(det));
        }
    }
    if (area > 0) {
        chart.scale = {
            std::max(static_cast<float>(u / area), kMinStretch),
            std::max(static_cast<float>(v / area), kMinStretch)};
    }
    return chart;
}

const FurChart& FurList::chart_of(MeshId mesh, const Assets& assets) {
    if (assets_ != assets.identity.value()) {
        assets_ = assets.identity.value();
        charts_.clear();
    }
    const MeshData& data = assets.meshes[mesh.index];
    const auto [found, is_new] = charts_.try_emplace(mesh.index);
    if (is_new || found->second.version != data.version) {
        found->second = {data.version, find_fur_chart(data)};
    }
    return found->second.chart;
}

std::optional<std::uint8_t> FurList::add(const Fur& fur, MeshId mesh, const Assets& assets) {
    if (mesh.index >= assets.meshes.size()) {
        return std::nullopt;
    }
    const layout::FurRecord record = make_fur_record(fur, chart_of(mesh, assets));
    const auto same = [&](const layout::FurRecord& other) {
        return std::memcmp(&other, &record, sizeof record) == 0;
    };
    const auto found = std::find_if(records_.begin(), records_.end(), same);
    if (found == records_.end()) {
        if (records_.size() == layout::kMaxFurs) {
            if (!reported_) {
                log_warn(
                    "fur: more than {} different coats; the others are bare", layout::kMaxFurs);
                reported_ = true;
            }
            return std::nullopt;
        }
        records_.push_back(record);
        return static_cast<std::uint8_t>(records_.size() - 1);
    }
    return static_cast<std::uint8_t>(found - records_.begin());
}

void FurList::upload(gpu::RingBuffer& ring) {
    if (records_.empty()) {
        return;
    }
    if (texture_ == nullptr) {
        texture_ = std::make_unique<BufferTexture>("furs", static_cast<GLenum>(GL_RGBA32F));
    }
    texture_->upload(ring, records_);
}

void FurList::bind(gpu::Device& device) const {
    if (!records_.empty() && texture_ != nullptr) {
        texture_->bind(device, layout::kFursUnit);
    }
}

}  // namespace limn
