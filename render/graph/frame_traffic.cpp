#include "render/graph/frame_graph.h"
#include "render/graph/frame_graph_impl.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

// Techniques: engine.opt-framebuffer

namespace limn {
namespace {

/// The part of a texture that is attached or, with a level or layer, read.
std::size_t texture_part(gpu::TextureDesc desc, const Use& use) {
    if (desc.target == GL_TEXTURE_3D) {
        desc.depth = std::max(desc.depth >> use.level, 1);
    }
    desc.width = std::max(desc.width >> use.level, 1);
    desc.height = std::max(desc.height >> use.level, 1);
    desc.levels = 1;
    const std::size_t bytes = gpu::texture_bytes(desc);
    const int layers = desc.target == GL_TEXTURE_CUBE_MAP ? 6 : desc.depth;
    return use.layer < 0 ? bytes : bytes / static_cast<std::size_t>(std::max(layers, 1));
}

}  // namespace

std::vector<PassTraffic> FrameGraph::traffic() const {
    const Impl& graph = *impl_;
    const auto bytes_of = [&](std::span<const Use> uses, bool written) {
        std::size_t bytes = 0;
        for (const Use& use : uses) {
            const Impl::Resource& resource = graph.resources[use.resource];
            if (!resource.is_texture) {
                bytes += resource.bytes;
            } else if (graph.is_target(use, written) || use.level > 0 || use.layer >= 0) {
                bytes += texture_part(resource.desc, use);
            } else {
                bytes += gpu::texture_bytes(resource.desc);
            }
        }
        return bytes;
    };
    std::vector<PassTraffic> traffic;
    for (const Impl::Pass& pass : graph.passes) {
        if (pass.runs) {
            traffic.push_back(
                {graph.names[pass.name], bytes_of(graph.reads(pass), false),
                 bytes_of(graph.writes(pass), true)});
        }
    }
    return traffic;
}

std::vector<TargetCost> FrameGraph::targets() const {
    const Impl& graph = *impl_;
    std::vector<TargetCost> targets;
    for (const Impl::Resource& resource : graph.resources) {
        if (resource.is_texture && !resource.imported() && resource.first >= 0) {
            const gpu::FormatInfo& info = gpu::format_info(resource.desc.format);
            targets.push_back(
                {graph.name_of(resource), info.name, info.bytes, resource.desc.width,
                 resource.desc.height, gpu::texture_bytes(resource.desc)});
        }
    }
    return targets;
}

}  // namespace limn
