#include "ecs/base/text.h"
#include "render/graph/frame_graph.h"
#include "render/graph/frame_graph_impl.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kFrameStart = ~0u;  // tag of the first timestamp of a frame
constexpr double kSmoothing =
    0.1;  // weight of the newest frame: averages over about 20 frames; by eye
constexpr std::size_t kMaxColors = 8;

// All accesses that may follow a shader write; a barrier costs the same for any set of bits.
constexpr GLbitfield kTextureBarrier =
    GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT
    | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT;
constexpr GLbitfield kBufferBarrier =
    GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT
    | GL_ELEMENT_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT
    | GL_TEXTURE_FETCH_BARRIER_BIT | GL_ATOMIC_COUNTER_BARRIER_BIT;

double milliseconds(Clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}

void smooth(double& value, bool& initialized, double sample) {
    value = initialized ? value + kSmoothing * (sample - value) : sample;
    initialized = true;
}

}  // namespace

void FrameGraph::execute() {
    Impl& graph = *impl_;
    LIMN_CHECK_NOTE(!graph.executed, "execute() called twice without begin_frame()");
    const Status valid = validate();
    LIMN_CHECK_NOTE(valid.ok(), valid.ok() ? "" : valid.error().message.c_str());

    ++graph.frame;
    graph.stats = {};
    graph.hazards.clear();
    graph.plan();
    graph.collect_gpu_times(false);

    const Clock::time_point begin = Clock::now();
    if (graph.gpu_timing) {
        graph.timer.begin_frame();
        graph.timer.mark(kFrameStart);
    }
    PassContext context(graph.device, *this);
    for (std::size_t i = 0; i < graph.passes.size(); ++i) {
        if (graph.passes[i].runs) {
            graph.run_pass(graph.passes[i], static_cast<int>(i), context);
        }
    }
    if (graph.gpu_timing) {
        graph.timer.end_frame();
    }
    // Code outside the graph reads the results without issuing a barrier.
    bool unsynced = false;
    for (Impl::Resource& r : graph.resources) {
        if ((r.imported() || r.slot != TargetPool::kNoOwner) && graph.unsynced(r)) {
            graph.unsynced(r) = false;
            unsynced = true;
        }
    }
    if (unsynced) {
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        ++graph.stats.barriers;
    }
    smooth(graph.total_cpu_ms, graph.total_cpu_valid, milliseconds(Clock::now() - begin));
    graph.executed = true;
    graph.stats.pool_textures = graph.pool.texture_count();
    graph.stats.framebuffers = graph.pool.framebuffer_count();
    graph.stats.pool_bytes = graph.pool.bytes();
    graph.publish_timings();
}

void FrameGraph::collect_hazards(bool on) {
    impl_->collects_hazards = on;
}

const std::vector<std::string>& FrameGraph::hazards() const {
    return impl_->hazards;
}

/// Culls passes and determines the lifetime of every resource.
void FrameGraph::Impl::plan() {
    // Backwards: a pass runs if its output is needed later, and then its inputs are needed.
    std::vector<std::uint8_t>& needed = scratch;
    needed.assign(resources.size(), 0);
    for (std::size_t i = 0; i < resources.size(); ++i) {
        needed[i] = resources[i].kept ? 1 : 0;
    }
    for (std::size_t i = passes.size(); i-- > 0;) {
        Pass& pass = passes[i];
        pass.runs = pass.always;
        for (const Use& use : writes(pass)) {
            pass.runs =
                pass.runs || needed[use.resource] != 0 || resources[use.resource].imported();
        }
        if (!pass.runs) {
            continue;
        }
        for (const Use& use : writes(pass)) {
            const Resource& r = resources[use.resource];
            const bool replaces = use.how == Use::How::Cleared || use.how == Use::How::Discarded;
            // Drawing over a target needs its contents; replacing all of it does not.
            const bool whole = r.desc.levels == 1 && use.layer < 0;
            needed[use.resource] = replaces && whole ? 0 : 1;
        }
        for (const Use& use : reads(pass)) {
            needed[use.resource] = 1;
        }
    }
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const Pass& pass = passes[i];
        if (!pass.runs) {
            ++stats.passes_culled;
            continue;
        }
        ++stats.passes_run;
        for (std::uint32_t u = pass.reads; u < pass.end; ++u) {
            Resource& r = resources[uses[u].resource];
            r.first = r.first < 0 ? static_cast<int>(i) : r.first;
            r.last = static_cast<int>(i);
        }
    }
    for (Resource& r : resources) {
        if (r.kept && r.first >= 0) {
            r.last = static_cast<int>(passes.size());  // released by begin_frame()
        }
        if (!r.imported() && r.first >= 0) {
            stats.unshared_bytes += r.is_texture ? gpu::texture_bytes(r.desc) : r.bytes;
        }
    }
}

void FrameGraph::Impl::acquire(const Pass& pass, int number) {
    for (std::uint32_t u = pass.reads; u < pass.end; ++u) {
        Resource& r = resources[uses[u].resource];
        if (!r.imported() && r.first == number && r.slot == TargetPool::kNoOwner) {
            r.slot = r.is_texture ? pool.acquire_texture(r.desc, uses[u].resource)
                                  : pool.acquire_buffer(r.bytes, uses[u].resource);
        }
    }
}

void FrameGraph::Impl::release(const Pass& pass, int number) {
    for (std::uint32_t u = pass.reads; u < pass.end; ++u) {
        const Resource& r = resources[uses[u].resource];
        if (!r.imported() && r.last == number) {
            if (r.is_texture) {
                pool.release_texture(r.slot);
            } else {
                pool.release_buffer(r.slot);
            }
        }
    }
}

bool& FrameGraph::Impl::unsynced(Resource& resource) {
    if (resource.imported()) {
        return resource.unsynced;
    }
    return resource.is_texture ? pool.texture_unsynced(resource.slot)
                               : pool.buffer_unsynced(resource.slot);
}

void FrameGraph::Impl::synchronize(const Pass& pass) {
    GLbitfield barrier = 0;
    for (std::uint32_t u = pass.reads; u < pass.end; ++u) {
        Resource& r = resources[uses[u].resource];
        if (unsynced(r)) {
            barrier |= r.is_texture ? kTextureBarrier : kBufferBarrier;
        }
    }
    if (barrier == 0) {
        return;
    }
    glMemoryBarrier(barrier);
    ++stats.barriers;
    // A barrier covers everything written so far, not only what this pass uses.
    for (Resource& r : resources) {
        const bool covered = (barrier & (r.is_texture ? kTextureBarrier : kBufferBarrier)) != 0;
        if (covered && (r.imported() || r.slot != TargetPool::kNoOwner)) {
            unsynced(r) = false;
        }
    }
}

void FrameGraph::Impl::mark_unsynced(const Pass& pass) {
    for (const Use& use : writes(pass)) {
        Resource& r = resources[use.resource];
        r.written = true;
        if (!is_target(use, true)) {
            unsynced(r) = true;
        }
    }
}

const gpu::Texture& FrameGraph::Impl::physical_texture(const Resource& resource) const {
    LIMN_CHECK(resource.is_texture);
    return resource.imported_texture != nullptr ? *resource.imported_texture
                                                : pool.texture(resource.slot);
}

IVec2 FrameGraph::Impl::bind_targets(const Pass& pass) {
    std::array<gpu::Attachment, kMaxColors> colors;
    std::size_t color_count = 0;
    gpu::Attachment depth;
    bool clears = false;
    const auto attachment = [&](const Use& use) {
        return gpu::Attachment{&physical_texture(resources[use.resource]), use.level, use.layer};
    };
    for (const Use& use : reads(pass)) {
        if (use.how == Use::How::DepthTest) {
            depth = attachment(use);
        }
    }
    for (const Use& use : writes(pass)) {
        const Resource& r = resources[use.resource];
        if (!is_target(use, true)) {
            continue;
        }
        clears = clears || use.how == Use::How::Cleared;
        if (gpu::format_info(r.desc.format).depth) {
            depth = attachment(use);
        } else {
            LIMN_CHECK(color_count < kMaxColors);
            colors[color_count++] = attachment(use);
        }
    }
    if (color_count == 0 && depth.texture == nullptr) {
        return {0, 0};
    }
    const gpu::Framebuffer& framebuffer =
        pool.framebuffer(std::span(colors.data(), color_count), depth);
    device.bind_framebuffer(framebuffer);
    device.disable_scissor();
    if (clears) {
        device.apply({});  // masks apply to clears
        int color_index = 0;
        for (const Use& use : writes(pass)) {
            const Resource& r = resources[use.resource];
            if (!is_target(use, true)) {
                continue;
            }
            if (use.how == Use::How::Cleared) {
                clear_target(framebuffer.id(), use, color_index);
            }
            color_index += gpu::format_info(r.desc.format).depth ? 0 : 1;
        }
    }
    return {framebuffer.width(), framebuffer.height()};
}

void FrameGraph::Impl::clear_target(GLuint framebuffer, const Use& use, int color_index) {
    const gpu::FormatInfo& info = gpu::format_info(resources[use.resource].desc.format);
    if (info.stencil) {
        glClearNamedFramebufferfi(
            framebuffer, GL_DEPTH_STENCIL, 0, use.clear.x, static_cast<GLint>(use.clear.y));
    } else if (info.depth) {
        glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &use.clear.x);
    } else if (info.integer && info.pixel_type == GL_INT) {
        const std::array<GLint, 4> value = {
            static_cast<GLint>(use.clear.x), static_cast<GLint>(use.clear.y),
            static_cast<GLint>(use.clear.z), static_cast<GLint>(use.clear.w)};
        glClearNamedFramebufferiv(framebuffer, GL_COLOR, color_index, value.data());
    } else if (info.integer) {
        const std::array<GLuint, 4> value = {
            static_cast<GLuint>(use.clear.x), static_cast<GLuint>(use.clear.y),
            static_cast<GLuint>(use.clear.z), static_cast<GLuint>(use.clear.w)};
        glClearNamedFramebufferuiv(framebuffer, GL_COLOR, color_index, value.data());
    } else {
        glClearNamedFramebufferfv(framebuffer, GL_COLOR, color_index, &use.clear.x);
    }
}

void FrameGraph::Impl::check_hazards(const gpu::Program& program) {
    std::string hazard = find_hazard(program);
    LIMN_CHECK_NOTE(hazard.empty() || collects_hazards, hazard.c_str());
    if (!hazard.empty()) {
        hazards.push_back(std::move(hazard));
    }
}

std::string FrameGraph::Impl::find_hazard(const gpu::Program& program) const {
    const auto name_of_object = [&](const Resource& r) -> GLuint {
        if (!r.imported() && r.slot == TargetPool::kNoOwner) {
            return 0;
        }
        return r.is_texture                   ? physical_texture(r).id()
               : r.imported_buffer != nullptr ? r.imported_buffer->id()
                                              : pool.buffer(r.slot).id();
    };
    for (const gpu::ProgramBinding& binding : program.bindings()) {
        const GLuint bound = device.bound_object(binding.kind, binding.binding);
        const bool texture =
            binding.kind == gpu::BindingKind::Texture || binding.kind == gpu::BindingKind::Image;
        for (std::uint32_t i = 0; bound != 0 && i < resources.size(); ++i) {
            const Resource& r = resources[i];
            const int number = static_cast<int>(running - passes.data());
            const bool alive = r.imported() || (r.first <= number && number <= r.last);
            if (r.is_texture != texture || !alive || name_of_object(r) != bound) {
                continue;
            }
            const auto same = [i](const Use& use) { return use.resource == i; };
            const std::span<const Use> read = reads(*running);
            const std::span<const Use> write = writes(*running);
            const bool declared_read = std::any_of(read.begin(), read.end(), same);
            const auto target = std::find_if(write.begin(), write.end(), same);
            const bool attached = target != write.end() && is_target(*target, true);
            if (r.written && !declared_read && target == write.end()) {
                return format_text(
                    "pass {}: {} binds {}, which this frame writes; expected among its reads",
                    names[running->name], binding.name, name_of(r));
            }
            if (attached && binding.kind == gpu::BindingKind::Texture && target->level == 0
                && target->layer < 0) {
                return format_text(
                    "pass {}: {} reads {} while the pass draws to it", names[running->name],
                    binding.name, name_of(r));
            }
        }
    }
    return {};
}

void FrameGraph::Impl::run_pass(Pass& pass, int number, PassContext& context) {
    const Clock::time_point begin = Clock::now();
    const std::string& name = names[pass.name];
    glPushDebugGroup(
        GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(name.size()), name.data());
    acquire(pass, number);
    synchronize(pass);
    running = &pass;
    context.size_ = bind_targets(pass);
    for (const Use& use : reads(pass)) {
        if (use.unit >= 0) {
            device.bind_texture(
                static_cast<unsigned>(use.unit), physical_texture(resources[use.resource]),
                use.sampler);
        }
    }
    device.observe_draws(
        [](void* graph, const gpu::Program& program) {
            static_cast<Impl*>(graph)->check_hazards(program);
        },
        this);
    pass.run(pass.closure, context);
    device.observe_draws(nullptr, nullptr);
    running = nullptr;
    mark_unsynced(pass);
    release(pass, number);
    glPopDebugGroup();
    if (gpu_timing) {
        timer.mark(pass.name);
    }
    // Passes of the same name are summed.
    Times& t = times[pass.name];
    const double cost = milliseconds(Clock::now() - begin);
    t.last_cpu_ms = t.frame == frame ? t.last_cpu_ms + cost : cost;
    t.frame = frame;
}

void FrameGraph::Impl::collect_gpu_times(bool wait) {
    while (true) {
        const std::span<const gpu::GpuTimer::Mark> marks = timer.take(wait);
        if (marks.empty()) {
            return;
        }
        for (const gpu::GpuTimer::Mark& mark : marks) {
            if (mark.tag != kFrameStart) {
                times[mark.tag].last_gpu_ms = 0;
            }
        }
        const auto span_ms = [](std::uint64_t from, std::uint64_t to) {
            return to > from ? static_cast<double>(to - from) * 1e-6 : 0.0;
        };
        for (std::size_t i = 1; i < marks.size(); ++i) {
            times[marks[i].tag].last_gpu_ms += span_ms(marks[i - 1].time_ns, marks[i].time_ns);
        }
        for (std::size_t i = 1; i < marks.size(); ++i) {
            const bool last_of_name = std::none_of(
                marks.begin() + static_cast<std::ptrdiff_t>(i) + 1, marks.end(),
                [&](const auto& later) { return later.tag == marks[i].tag; });
            if (last_of_name) {
                Times& t = times[marks[i].tag];
                smooth(t.gpu_ms, t.gpu_valid, t.last_gpu_ms);
            }
        }
        smooth(total_gpu_ms, total_gpu_valid, span_ms(marks.front().time_ns, marks.back().time_ns));
    }
}

void FrameGraph::Impl::publish_timings() {
    timings.clear();
    timed_names.clear();
    for (const Pass& pass : passes) {
        if (!pass.runs
            || std::find(timed_names.begin(), timed_names.end(), pass.name) != timed_names.end()) {
            continue;
        }
        timed_names.push_back(pass.name);
        Times& t = times[pass.name];
        smooth(t.cpu_ms, t.cpu_valid, t.last_cpu_ms);
        timings.push_back({names[pass.name], t.cpu_ms, t.gpu_ms, t.last_cpu_ms, t.last_gpu_ms});
    }
}

void FrameGraph::wait_for_timings() {
    impl_->collect_gpu_times(true);
    for (std::size_t i = 0; i < impl_->timings.size(); ++i) {
        const Impl::Times& t = impl_->times[impl_->timed_names[i]];
        impl_->timings[i].gpu_ms = t.gpu_ms;
        impl_->timings[i].last_gpu_ms = t.last_gpu_ms;
    }
}

}  // namespace limn
