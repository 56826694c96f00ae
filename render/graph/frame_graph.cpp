#include "render/graph/frame_graph.h"

#include "ecs/base/text.h"
#include "render/graph/frame_graph_impl.h"

#include <algorithm>

namespace limn {
namespace {

// An id has the resource's index in the low bits and its frame's generation in the high bits, so
// that stale ids are detected.
constexpr std::uint32_t kIndexBits = 16;
constexpr std::uint32_t kIndexMask = (1u << kIndexBits) - 1;
constexpr std::uint32_t kGenerationMask = 0x7fff;  // leaves ~0u for "no id"

constexpr std::size_t kArenaBlock = 64 * 1024;

gpu::TextureDesc desc_of(const TextureSpec& spec) {
    return {spec.format, spec.width,   spec.height, spec.depth,
            spec.levels, spec.samples, spec.target};
}

}  // namespace

FrameGraph::FrameGraph(gpu::Device& device) : impl_(std::make_unique<Impl>(device)) {}

FrameGraph::~FrameGraph() {
    impl_->destroy_closures();
}

void FrameGraph::begin_frame() {
    impl_->destroy_closures();
    impl_->passes.clear();
    impl_->uses.clear();
    impl_->resources.clear();
    impl_->generation = (impl_->generation + 1) & kGenerationMask;
    impl_->executed = false;
    impl_->pool.begin_frame();
}

TextureId FrameGraph::create(const TextureSpec& spec) {
    LIMN_CHECK(!spec.name.empty());
    LIMN_CHECK(spec.width > 0 && spec.height > 0 && spec.depth > 0 && spec.levels >= 0);
    Impl::Resource resource;
    resource.name = impl_->intern(spec.name);
    resource.desc = desc_of(spec);
    resource.kept = !impl_->kept_names.empty() && impl_->kept_names.contains(spec.name);
    return {impl_->add_resource(resource)};
}

BufferId FrameGraph::create_buffer(const BufferSpec& spec) {
    LIMN_CHECK(!spec.name.empty() && spec.bytes > 0);
    Impl::Resource resource;
    resource.name = impl_->intern(spec.name);
    resource.is_texture = false;
    resource.bytes = spec.bytes;
    return {impl_->add_resource(resource)};
}

TextureId FrameGraph::import(std::string_view name, const gpu::Texture& texture) {
    LIMN_CHECK(texture);
    if (const std::uint32_t known = impl_->find_imported(&texture); known != ~0u) {
        return {known};
    }
    Impl::Resource resource;
    resource.name = impl_->intern(name);
    resource.desc = texture.desc();
    resource.imported_texture = &texture;
    return {impl_->add_resource(resource)};
}

BufferId FrameGraph::import(std::string_view name, const gpu::Buffer& buffer) {
    LIMN_CHECK(buffer);
    if (const std::uint32_t known = impl_->find_imported(&buffer); known != ~0u) {
        return {known};
    }
    Impl::Resource resource;
    resource.name = impl_->intern(name);
    resource.is_texture = false;
    resource.bytes = buffer.size();
    resource.imported_buffer = &buffer;
    return {impl_->add_resource(resource)};
}

void FrameGraph::begin_scope(std::string_view scope) {
    impl_->scope = scope;
    if (!scope.empty()) {
        impl_->scope += '/';
    }
}

void FrameGraph::end_scope() {
    impl_->scope.clear();
}

void FrameGraph::always_run() {
    LIMN_CHECK(!impl_->passes.empty());
    impl_->passes.back().always = true;
}

void FrameGraph::keep(TextureId texture) {
    impl_->resource(texture.index).kept = true;
}

void FrameGraph::keep_named(std::string_view name) {
    impl_->kept_names.emplace(name);
}

void FrameGraph::forget_named(std::string_view name) {
    if (const auto found = impl_->kept_names.find(name); found != impl_->kept_names.end()) {
        impl_->kept_names.erase(found);
    }
}

void* FrameGraph::allocate_closure(std::size_t size, std::size_t alignment) {
    LIMN_CHECK(size <= kArenaBlock && alignment <= alignof(std::max_align_t));
    Impl::Arena& arena = impl_->arena;
    std::size_t at = (arena.used + alignment - 1) / alignment * alignment;
    if (!arena.blocks.empty() && at + size > kArenaBlock) {
        ++arena.block;
        at = 0;
    }
    if (arena.block >= arena.blocks.size()) {
        arena.blocks.push_back(std::make_unique<std::byte[]>(kArenaBlock));
    }
    arena.used = at + size;
    return arena.blocks[arena.block].get() + at;
}

void FrameGraph::add_pass_erased(
    std::string_view name, std::span<const Use> reads, std::span<const Use> writes, void* closure,
    RunFunction run, DestroyFunction destroy) {
    Impl& graph = *impl_;
    LIMN_CHECK_NOTE(graph.running == nullptr, "add_pass() called while a pass is running");
    Impl::Pass pass;
    graph.scoped_name.assign(graph.scope).append(name);
    pass.name = graph.intern(graph.scoped_name);
    pass.reads = static_cast<std::uint32_t>(graph.uses.size());
    graph.uses.insert(graph.uses.end(), reads.begin(), reads.end());
    pass.writes = static_cast<std::uint32_t>(graph.uses.size());
    graph.uses.insert(graph.uses.end(), writes.begin(), writes.end());
    pass.end = static_cast<std::uint32_t>(graph.uses.size());
    for (std::uint32_t i = pass.reads; i < pass.end; ++i) {
        graph.uses[i].resource = graph.index_of(graph.uses[i].resource);
    }
    pass.closure = closure;
    pass.run = run;
    pass.destroy = destroy;
    graph.passes.push_back(pass);
}

Status FrameGraph::validate() const {
    const Impl& graph = *impl_;
    std::vector<std::uint8_t>& written = impl_->scratch;
    written.assign(graph.resources.size(), 0);
    for (std::size_t i = 0; i < graph.resources.size(); ++i) {
        written[i] = graph.resources[i].imported() ? 1 : 0;
    }
    for (const Impl::Pass& pass : graph.passes) {
        const std::string& pass_name = graph.names[pass.name];
        for (const Use& use : graph.reads(pass)) {
            const Impl::Resource& r = graph.resources[use.resource];
            if (written[use.resource] == 0) {
                return fail(
                    "frame graph: pass {}: read of {} before any write found, expected an earlier "
                    "pass that writes it",
                    pass_name, graph.name_of(r));
            }
            for (const Use& write : graph.writes(pass)) {
                // A shader may read and write the same image or block, but must not sample a
                // target, except to draw one level or layer from the others (mip chains).
                const bool whole = write.level == 0 && write.layer < 0;
                if (write.resource == use.resource && graph.is_target(write, true) && whole) {
                    return fail(
                        "frame graph: pass {}: {} found both read and drawn to, expected one of "
                        "them",
                        pass_name, graph.name_of(r));
                }
            }
        }
        IVec2 size = {0, 0};
        const auto check_size = [&](const Use& use) -> Status {
            const Impl::Resource& r = graph.resources[use.resource];
            const IVec2 own = {
                std::max(r.desc.width >> use.level, 1), std::max(r.desc.height >> use.level, 1)};
            if (size.x != 0 && own != size) {
                return fail(
                    "frame graph: pass {}: target {} of {}x{} found, expected {}x{} like its other "
                    "targets",
                    pass_name, graph.name_of(r), own.x, own.y, size.x, size.y);
            }
            size = own;
            return Done{};
        };
        for (std::uint32_t i = pass.reads; i < pass.end; ++i) {
            if (graph.is_target(graph.uses[i], i >= pass.writes)) {
                const Status status = check_size(graph.uses[i]);
                if (!status) {
                    return status;
                }
            }
        }
        for (const Use& use : graph.writes(pass)) {
            written[use.resource] = 1;
        }
    }
    return Done{};
}

TextureId FrameGraph::find(std::string_view name) const {
    const auto found = impl_->name_index.find(name);
    if (found == impl_->name_index.end()) {
        return {};
    }
    for (std::size_t i = impl_->resources.size(); i-- > 0;) {
        if (impl_->resources[i].name == found->second && impl_->resources[i].is_texture) {
            return {impl_->generation << kIndexBits | static_cast<std::uint32_t>(i)};
        }
    }
    return {};
}

TextureSpec FrameGraph::spec(TextureId id) const {
    const Impl::Resource& r = impl_->resource(id.index);
    return {impl_->name_of(r), r.desc.format, r.desc.width,   r.desc.height,
            r.desc.depth,      r.desc.levels, r.desc.samples, r.desc.target};
}

const gpu::Texture* FrameGraph::texture(TextureId id) const {
    const Impl::Resource& r = impl_->resource(id.index);
    LIMN_CHECK(r.is_texture);
    if (r.imported_texture != nullptr) {
        return r.imported_texture;
    }
    const bool holds = r.slot != TargetPool::kNoOwner
                       && impl_->pool.owner_of_texture(r.slot) == (id.index & kIndexMask);
    return holds ? &impl_->pool.texture(r.slot) : nullptr;
}

std::vector<std::string_view> FrameGraph::texture_names() const {
    std::vector<std::string_view> names;
    for (const Impl::Resource& r : impl_->resources) {
        const std::string_view name = impl_->name_of(r);
        if (r.is_texture && std::find(names.begin(), names.end(), name) == names.end()) {
            names.push_back(name);
        }
    }
    return names;
}

bool FrameGraph::was_run(std::string_view pass) const {
    return impl_->executed
           && std::any_of(impl_->passes.begin(), impl_->passes.end(), [&](const Impl::Pass& p) {
                  return p.runs && impl_->names[p.name] == pass;
              });
}

std::span<const PassTiming> FrameGraph::timings() const {
    return impl_->timings;
}
double FrameGraph::total_cpu_ms() const {
    return impl_->total_cpu_ms;
}
double FrameGraph::total_gpu_ms() const {
    return impl_->total_gpu_ms;
}
void FrameGraph::set_gpu_timing(bool on) {
    impl_->gpu_timing = on;
}
const FrameGraph::Stats& FrameGraph::stats() const {
    return impl_->stats;
}

std::uint32_t FrameGraph::Impl::intern(std::string_view name) {
    if (const auto found = name_index.find(name); found != name_index.end()) {
        return found->second;
    }
    const auto index = static_cast<std::uint32_t>(names.size());
    names.emplace_back(name);
    name_index.emplace(name, index);
    times.emplace_back();
    return index;
}

std::uint32_t FrameGraph::Impl::add_resource(const Resource& resource) {
    LIMN_CHECK(resources.size() < kIndexMask);
    resources.push_back(resource);
    return generation << kIndexBits | static_cast<std::uint32_t>(resources.size() - 1);
}

std::uint32_t FrameGraph::Impl::find_imported(const void* object) const {
    for (std::size_t i = 0; i < resources.size(); ++i) {
        if (resources[i].imported_texture == object || resources[i].imported_buffer == object) {
            return generation << kIndexBits | static_cast<std::uint32_t>(i);
        }
    }
    return ~0u;
}

std::uint32_t FrameGraph::Impl::index_of(std::uint32_t id) const {
    LIMN_CHECK_NOTE(id != ~0u, "invalid resource id");
    LIMN_CHECK_NOTE(id >> kIndexBits == generation, "stale resource id from an earlier frame");
    LIMN_CHECK((id & kIndexMask) < resources.size());
    return id & kIndexMask;
}

const FrameGraph::Impl::Resource& FrameGraph::Impl::resource(std::uint32_t id) const {
    return resources[index_of(id)];
}

FrameGraph::Impl::Resource& FrameGraph::Impl::resource(std::uint32_t id) {
    return resources[index_of(id)];
}

bool FrameGraph::Impl::is_target(const Use& use, bool written) const {
    return resources[use.resource].is_texture
           && (written ? use.how != Use::How::Image : use.how == Use::How::DepthTest);
}

void FrameGraph::Impl::destroy_closures() {
    for (const Pass& pass : passes) {
        if (pass.closure != nullptr) {
            pass.destroy(pass.closure);
        }
    }
    arena.block = 0;
    arena.used = 0;
}

const gpu::Texture& PassContext::texture(TextureId id) const {
    const FrameGraph::Impl& graph = *graph_.impl_;
    const std::uint32_t index = graph.index_of(id.index);
    const FrameGraph::Impl::Pass& pass = *graph.running;
    const bool declared = std::any_of(
        graph.uses.begin() + pass.reads, graph.uses.begin() + pass.end,
        [=](const Use& use) { return use.resource == index; });
    LIMN_CHECK_NOTE(declared, "texture used by a pass that did not declare it");
    return graph.physical_texture(graph.resources[index]);
}

const gpu::Buffer& PassContext::buffer(BufferId id) const {
    const FrameGraph::Impl& graph = *graph_.impl_;
    const std::uint32_t index = graph.index_of(id.index);
    const FrameGraph::Impl::Resource& r = graph.resources[index];
    const FrameGraph::Impl::Pass& pass = *graph.running;
    const bool declared = std::any_of(
        graph.uses.begin() + pass.reads, graph.uses.begin() + pass.end,
        [=](const Use& use) { return use.resource == index; });
    LIMN_CHECK_NOTE(declared && !r.is_texture, "buffer used by a pass that did not declare it");
    return r.imported_buffer != nullptr ? *r.imported_buffer : graph.pool.buffer(r.slot);
}

void PassContext::bind_texture(unsigned unit, TextureId id, const gpu::Sampler* sampler) const {
    device_.bind_texture(unit, texture(id), sampler);
}

void PassContext::bind_image(
    unsigned unit, TextureId id, GLenum access, int level, int layer) const {
    device_.bind_image(unit, texture(id), access, level, layer);
}

void PassContext::bind_storage(unsigned binding, BufferId id) const {
    device_.bind_storage(binding, buffer(id));
}

void PassContext::bind_uniforms(unsigned binding, BufferId id) const {
    device_.bind_uniforms(binding, buffer(id));
}

}  // namespace limn
