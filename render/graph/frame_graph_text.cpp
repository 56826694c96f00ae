#include "ecs/base/text.h"
#include "render/graph/frame_graph.h"
#include "render/graph/frame_graph_impl.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

std::string dot_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
        }
        out += c;
    }
    return out + '"';
}

double mebibytes(std::size_t bytes) {
    return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

}  // namespace

std::string FrameGraph::to_text() const {
    const Impl& graph = *impl_;
    const auto list = [&](std::span<const Use> uses) {
        std::string text;
        for (const Use& use : uses) {
            text += (text.empty() ? "" : " ") + graph.name_of(graph.resources[use.resource]);
        }
        return text.empty() ? std::string("-") : text;
    };
    std::size_t widest = 4;
    for (const Impl::Pass& pass : graph.passes) {
        widest = std::max(widest, graph.names[pass.name].size());
    }
    std::string text = fmt::format("{:{}}  cpu ms  gpu ms  reads -> writes\n", "pass", widest);
    for (const Impl::Pass& pass : graph.passes) {
        const Impl::Times& t = graph.times[pass.name];
        const std::string flow = list(graph.reads(pass)) + " -> " + list(graph.writes(pass));
        if (graph.executed && !pass.runs) {
            text +=
                fmt::format("{:{}}  not run         {}\n", graph.names[pass.name], widest, flow);
        } else {
            text += fmt::format(
                "{:{}}  {:6.3f}  {:6.3f}  {}\n", graph.names[pass.name], widest, t.cpu_ms, t.gpu_ms,
                flow);
        }
    }
    for (const Impl::Resource& r : graph.resources) {
        if (!r.is_texture) {
            text += fmt::format("buffer {}: {} bytes", graph.name_of(r), r.bytes);
        } else {
            text += fmt::format(
                "texture {}: {} {}x{}", graph.name_of(r), gpu::format_info(r.desc.format).name,
                r.desc.width, r.desc.height);
        }
        if (r.imported()) {
            text += ", imported";
        } else if (graph.executed && r.first < 0) {
            text += ", unused";
        } else if (graph.executed) {
            text += fmt::format(
                ", {} slot {}{}", r.is_texture ? "texture" : "buffer", r.slot,
                r.kept ? ", kept" : "");
        }
        text += '\n';
    }
    text += fmt::format(
        "pool: {} textures, {:.1f} MiB; {:.1f} MiB without sharing; {} barriers\n",
        graph.stats.pool_textures, mebibytes(graph.stats.pool_bytes),
        mebibytes(graph.stats.unshared_bytes), graph.stats.barriers);
    return text;
}

std::string FrameGraph::to_dot() const {
    const Impl& graph = *impl_;
    std::string text = "digraph frame {\n    rankdir=LR;\n";
    const auto pass_node = [](std::size_t i) { return fmt::format("p{}", i); };
    const auto resource_node = [](std::size_t i) { return fmt::format("r{}", i); };
    for (std::size_t i = 0; i < graph.passes.size(); ++i) {
        const Impl::Pass& pass = graph.passes[i];
        const bool dropped = graph.executed && !pass.runs;
        text += fmt::format(
            "    {} [shape=box, label={}{}];\n", pass_node(i), dot_string(graph.names[pass.name]),
            dropped ? ", style=dashed" : "");
    }
    for (std::size_t i = 0; i < graph.resources.size(); ++i) {
        const Impl::Resource& r = graph.resources[i];
        text += fmt::format(
            "    {} [shape=ellipse, label={}{}];\n", resource_node(i), dot_string(graph.name_of(r)),
            r.imported() ? ", style=bold" : "");
    }
    for (std::size_t i = 0; i < graph.passes.size(); ++i) {
        for (const Use& use : graph.reads(graph.passes[i])) {
            text += fmt::format("    {} -> {};\n", resource_node(use.resource), pass_node(i));
        }
        for (const Use& use : graph.writes(graph.passes[i])) {
            text += fmt::format("    {} -> {};\n", pass_node(i), resource_node(use.resource));
        }
    }
    return text + "}\n";
}

}  // namespace limn
