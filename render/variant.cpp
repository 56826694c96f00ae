#include "render/variant.h"

#include "ecs/base/log.h"
#include "render/geometry/mesh_pool.h"
#include "render/gpu/device.h"
#include "render/material/material_pool.h"
#include "render/material/relief_hook.h"

#include <algorithm>
#include <utility>

namespace limn {
namespace {

/// FNV-1a, then mixed so that sums of hashes do not collide.
std::uint64_t hash_of_definition(std::string_view name, int value) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const char c : name) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    }
    hash = (hash ^ static_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15ull;
    return hash ^ (hash >> 29);
}

}  // namespace

const Variant::Definition* Variant::find(std::string_view name) const {
    for (int i = 0; i < count_; ++i) {
        if (name == definitions_[i].name) {
            return &definitions_[i];
        }
    }
    return nullptr;
}

void Variant::add(const char* name, int value) {
    if (const Definition* known = find(name)) {
        LIMN_CHECK_NOTE(known->value == value, name);
        return;
    }
    LIMN_CHECK(count_ < kMaxDefinitions);
    definitions_[count_++] = {name, value};
    key_ += hash_of_definition(name, value);
}

void Variant::add(const Variant& other) {
    for (int i = 0; i < other.count_; ++i) {
        add(other.definitions_[i].name, other.definitions_[i].value);
    }
}

std::vector<gpu::ShaderDefine> Variant::definitions() const {
    std::vector<gpu::ShaderDefine> defines;
    for (int i = 0; i < count_; ++i) {
        defines.push_back({definitions_[i].name, std::to_string(definitions_[i].value)});
    }
    std::sort(defines.begin(), defines.end(), [](const auto& a, const auto& b) {
        return a.name < b.name;
    });
    return defines;
}

bool Variant::operator==(const Variant& other) const {
    return key_ == other.key_ && count_ == other.count_
           && std::all_of(
               definitions_.begin(), definitions_.begin() + count_, [&](const Definition& d) {
                   const Definition* same = other.find(d.name);
                   return same != nullptr && same->value == d.value;
               });
}

ProgramVariants::ProgramVariants(gpu::Device& device, gpu::ProgramDesc files, bool vertex_inputs)
    : device_(&device), files_(std::move(files)), vertex_inputs_(vertex_inputs) {}

ProgramVariants
ProgramVariants::of_meshes(gpu::Device& device, const char* fragment, const char* vertex) {
    return {device, {.vertex = vertex, .fragment = fragment}, true};
}

ProgramVariants ProgramVariants::fullscreen(gpu::Device& device, const char* fragment) {
    return {device, {.vertex = "fullscreen.vert", .fragment = fragment}};
}

const gpu::Program* ProgramVariants::get(const Variant& variant, const SurfaceFeatures& features) {
    const std::uint64_t key = variant.key() ^ features.bits * 0xd6e8feb86659fd93ull
                              ^ features.maps.key() * 0x9e3779b97f4a7c15ull
                              ^ features.hooks.key() * 0xff51afd7ed558ccdull;
    if (const auto found = entries_.find(key); found != entries_.end()) {
        const Entry& entry = found->second;
        LIMN_CHECK(entry.features == features && entry.variant == variant);
        return entry.program;
    }
    Variant whole = variant;
    add_features(whole, features);
    gpu::ProgramDesc desc = files_;
    if (vertex_inputs_ && is_tessellated(features)) {
        whole.add("TESSELLATED");
        whole.add_if(device_->caps().software, "SMALL_PATCHES");
        desc.evaluation = std::exchange(desc.vertex, "tessellated.vert");
        desc.control = "tessellated.tesc";
    }
    desc.defines = whole.definitions();
    const Result<const gpu::Program*> program = device_->shaders().load(desc);
    const Status fits = !program         ? program.error()
                        : vertex_inputs_ ? (*program)->expect_inputs(mesh_attributes())
                                         : Status(Done{});
    if (!fits) {
        log_error("{}", fits.error().message);
    }
    return (entries_[key] = {variant, features, fits ? *program : nullptr}).program;
}

Status ProgramVariants::load(const Variant& variant, const SurfaceFeatures& features) {
    if (get(variant, features) == nullptr) {
        return fail("{}{}: does not compile, see the log", files_.fragment, files_.compute);
    }
    return Done{};
}

}  // namespace limn
