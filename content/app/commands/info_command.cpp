#include "content/app/commands/info_command.h"

#include "content/app/commands/headless.h"
#include "content/app/commands/trial_file.h"
#include "content/game/game.h"
#include "content/game/wrinkle_trial_system.h"
#include "content/load/faces/marker_file.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/dds_file.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/level/level_hints.h"
#include "content/load/scene_load.h"
#include "ecs/components/camera.h"
#include "ecs/components/image_blocks.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/particles.h"
#include "ecs/components/path.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/hierarchy.h"
#include "ecs/reflect.h"
#include "ecs/world.h"
#include "render/geometry/mesh_pool.h"
#include "render/geometry/triangle_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Techniques: anim.bezier-join, wrinkle.compression.ab-evaluation

namespace limn {
namespace {

constexpr std::size_t kMaxLines = 40;         // lines of a list; the rest are only counted
constexpr IVec2 kProgramsSize = {1280, 720};  // of the images that the programs are for

/// The file name's extension in lower case: ".png".
std::string extension_of(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    std::string extension = dot == std::string::npos ? "" : path.substr(dot);
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return extension;
}

void print_rest(std::size_t count) {
    if (count > kMaxLines) {
        fmt::print("    ... and {} more\n", count - kMaxLines);
    }
}

/// "1 mesh", "2 meshes", "3 entities".
std::string counted(std::size_t count, std::string_view what) {
    if (count == 1) {
        return fmt::format("1 {}", what);
    }
    if (what.ends_with('y')) {
        return fmt::format("{} {}ies", count, what.substr(0, what.size() - 1));
    }
    return fmt::format("{} {}{}", count, what, what.ends_with("sh") ? "es" : "s");
}

/// Entities of the file, without the camera, lights and ground that a model viewer adds.
std::vector<Entity> own_entities(const World& world, const LoadedScene& scene) {
    std::vector<Entity> own;
    world.each_entity([&](Entity entity) {
        if (!scene.model
            || std::find(scene.model->added.begin(), scene.model->added.end(), entity)
                   == scene.model->added.end()) {
            own.push_back(entity);
        }
    });
    std::sort(own.begin(), own.end(), [](Entity a, Entity b) { return a.index < b.index; });
    return own;
}

std::string name_of_shape(const World& world, Entity entity) {
    const auto* const name = world.find<Name>(entity);
    return name != nullptr ? name->text : "(no name)";
}

void print_components(const World& world, std::span<const Entity> entities) {
    std::map<std::string, std::size_t> counts;
    for (const Entity entity : entities) {
        for (const ComponentId id : world.components_of(entity)) {
            if (!is_internal(component_info(id))) {
                ++counts[component_info(id).name];
            }
        }
    }
    fmt::print("{}\n", counted(entities.size(), "entity"));
    for (const auto& [name, count] : counts) {
        fmt::print("    {:>8}  {}\n", count, name);
    }
}

/// A heading and a line for each; nothing if there are none.
void print_list(const char* what, const std::vector<std::string>& lines) {
    if (lines.empty()) {
        return;
    }
    fmt::print("{}\n", counted(lines.size(), what));
    for (std::size_t i = 0; i < std::min(lines.size(), kMaxLines); ++i) {
        fmt::print("    {}\n", lines[i]);
    }
    print_rest(lines.size());
}

void print_cameras_and_lights(const World& world, std::span<const Entity> entities) {
    std::vector<std::string> cameras;
    std::vector<std::string> lights;
    for (const Entity entity : entities) {
        const std::string name = name_of_shape(world, entity);
        if (const auto* const camera = world.find<Camera>(entity)) {
            const float height = camera->ortho_height;
            cameras.push_back(
                height > 0 ? fmt::format("{:>6.3g} m    {}", height, name)
                           : fmt::format("{:>6.1f} deg  {}", degrees(camera->fov_y), name));
        }
        if (const auto* const light = world.find<DirectionalLight>(entity)) {
            lights.push_back(fmt::format("directional  {:>8.4g} lx  {}", light->illuminance, name));
        }
        if (const auto* const light = world.find<PointLight>(entity)) {
            lights.push_back(fmt::format("point        {:>8.4g} cd  {}", light->intensity, name));
        }
        if (const auto* const light = world.find<SpotLight>(entity)) {
            lights.push_back(fmt::format("spot         {:>8.4g} cd  {}", light->intensity, name));
        }
    }
    print_list("camera", cameras);
    print_list("light", lights);
}

/// Capacity, bytes and executor of each emitter, copies in one line, and totals.
void print_particles(const World& world, std::span<const Entity> entities) {
    struct Budget {
        std::size_t emitters = 0;
        std::uint64_t capacity = 0;
        std::uint64_t bytes = 0;
    };
    std::map<std::string, std::size_t> lines;  // to indices in `budgets`
    std::vector<std::pair<std::string, Budget>> budgets;
    Budget sums[2];
    for (const Entity entity : entities) {
        const auto* const emitter = world.find<ParticleEmitter>(entity);
        if (emitter == nullptr) {
            continue;
        }
        const bool gpu = runs_on_gpu(*emitter);
        std::string name = name_of_shape(world, entity);
        name = fmt::format("{}  {}", gpu ? "gpu" : "cpu", name.substr(0, name.find('[')));
        const auto [line, is_new] = lines.try_emplace(name, budgets.size());
        if (is_new) {
            budgets.emplace_back(name, Budget{});
        }
        for (Budget* const budget : {&budgets[line->second].second, &sums[gpu ? 1 : 0]}) {
            ++budget->emitters;
            budget->capacity += emitter->capacity;
            budget->bytes += particle_bytes(*emitter);
        }
    }
    const auto text = [](const Budget& budget) {
        return fmt::format(
            "{:>4}  {:>8} particles  {:>9.1f} KiB", budget.emitters, budget.capacity,
            static_cast<double>(budget.bytes) / 1024);
    };
    std::vector<std::string> rows;
    for (const auto& [name, budget] : budgets) {
        rows.push_back(fmt::format("{}  {}", text(budget), name));
    }
    if (rows.empty()) {
        return;
    }
    fmt::print("{}\n", counted(sums[0].emitters + sums[1].emitters, "particle emitter"));
    for (std::size_t i = 0; i < std::min(rows.size(), kMaxLines); ++i) {
        fmt::print("    {}\n", rows[i]);
    }
    print_rest(rows.size());
    fmt::print("    {}  cpu, total\n    {}  gpu, total\n", text(sums[0]), text(sums[1]));
}

/// Names, children indented below their parents.
void print_hierarchy(World& world, std::span<const Entity> entities) {
    struct Open {
        Entity entity;
        std::size_t depth = 0;
    };
    std::vector<Open> open;
    for (const Entity entity : entities) {
        if (parent_of(world, entity).is_null()) {
            open.push_back({entity});
        }
    }
    std::reverse(open.begin(), open.end());
    if (!entities.empty()) {
        fmt::print("hierarchy\n");
    }
    for (std::size_t i = 0; i < kMaxLines && !open.empty(); ++i) {
        const auto [entity, depth] = open.back();
        open.pop_back();
        fmt::print("    {:{}}{}\n", "", 2 * depth, name_of_shape(world, entity));
        const std::span<const Entity> children = children_of(world, entity);
        for (auto child = children.rbegin(); child != children.rend(); ++child) {
            open.push_back({*child, depth + 1});
        }
    }
    print_rest(entities.size());
}

/// Length, and how many of its joins are smooth: in direction and speed, only in direction, or
/// not.
void print_path(const PathData& path) {
    std::array<int, 4> joins = {};
    for (const BezierJoin join : path_joins(path)) {
        ++joins[static_cast<std::size_t>(join)];
    }
    fmt::print(
        "path of {:.1f} m, {}; joins: {} of one speed, {} of one direction, {}  {}\n",
        path.length(), counted(path.segments.size(), "curve"),
        joins[static_cast<std::size_t>(BezierJoin::Speed)],
        joins[static_cast<std::size_t>(BezierJoin::Direction)],
        counted(
            static_cast<std::size_t>(joins[static_cast<std::size_t>(BezierJoin::Position)]),
            "corner"),
        path.name);
}

/// A factor that multiplies a texture says little about the color.
std::string factor_text(float factor, const TextureSlot& texture) {
    return texture.image.index != kNoAsset && factor > 0 ? "mapped" : fmt::format("{:.2f}", factor);
}

/// `meshes` and `materials`: those of the file.
void print_assets(
    const Assets& assets, std::span<const MeshData> meshes, std::span<const Material> materials) {
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    std::size_t index_bytes = 0;
    const auto transformed = [](const MeshData& mesh) {
        const std::size_t count = mesh.positions.size();
        const bool valid = mesh.indices.size() % 3 == 0
                           && std::ranges::all_of(mesh.indices, [&](auto i) { return i < count; });
        return valid ? transformed_per_triangle(order_for_cache(mesh.indices, count), count) : 0;
    };
    const auto bytes_of_index = [](const MeshData& mesh) {
        return index_size(mesh.positions.size() > kMaxShortVertices);
    };
    for (const MeshData& mesh : meshes) {
        triangles += mesh.indices.size() / 3;
        vertices += mesh.positions.size();
        index_bytes += bytes_of_index(mesh) * mesh.indices.size();
    }
    fmt::print(
        "{}, {}, {} vertices, {:.0f} KiB of indices\n", counted(meshes.size(), "mesh"),
        counted(triangles, "triangle"), vertices, static_cast<double>(index_bytes) / 1024);
    for (std::size_t i = 0; i < std::min(meshes.size(), kMaxLines); ++i) {
        const MeshData& mesh = meshes[i];
        const Vec3 size = is_empty(mesh.bounds) ? Vec3(0) : 2.0f * half_extent(mesh.bounds);
        fmt::print(
            "    {:>8} triangles  {}-bit indices  {:.2f} vertices transformed per triangle  {:.3g} "
            "x {:.3g} x "
            "{:.3g} "
            "m  {}\n",
            mesh.indices.size() / 3, 8 * bytes_of_index(mesh), transformed(mesh), size.x, size.y,
            size.z, mesh.name);
    }
    print_rest(meshes.size());

    const FieldInfo& shading = *find_field(component_info<Material>().fields, "shading");
    fmt::print("{}\n", counted(materials.size(), "material"));
    for (std::size_t i = 0; i < std::min(materials.size(), kMaxLines); ++i) {
        const Material& material = materials[i];
        const std::string clear = material.transmission > 0
                                      ? fmt::format("transmission {:.2f}  ", material.transmission)
                                      : "";
        fmt::print(
            "    {:<5}  metalness {:<6}  roughness {:<6}  {}{}\n",
            shading.values[static_cast<std::size_t>(material.shading)],
            factor_text(material.metalness, material.metal_rough_texture),
            factor_text(material.roughness, material.metal_rough_texture), clear, material.name);
    }
    print_rest(materials.size());

    fmt::print("{}\n", counted(assets.images.size(), "image"));
    for (std::size_t i = 0; i < std::min(assets.images.size(), kMaxLines); ++i) {
        const ImageData& image = assets.images[i];
        fmt::print(
            "    {:>5} x {:<5}  {:<7}  {}\n", image.width, image.height, format_name(image.format),
            image.name);
    }
    print_rest(assets.images.size());

    for (const PathData& path : assets.paths) {
        print_path(path);
    }
    for (const SkeletonData& skeleton : assets.skeletons) {
        fmt::print("skeleton of {}  {}\n", counted(skeleton.joints.size(), "joint"), skeleton.name);
        for (std::size_t i = 0; i < std::min(skeleton.joints.size(), kMaxLines); ++i) {
            fmt::print("    {}\n", skeleton.joints[i].empty() ? "(no name)" : skeleton.joints[i]);
        }
        print_rest(skeleton.joints.size());
    }
    std::vector<std::string> skins;
    for (const SkinData& skin : assets.skins) {
        skins.push_back(fmt::format(
            "{:>8} joints  {}", skin.joints.size(), skin.name.empty() ? "(no name)" : skin.name));
    }
    print_list("skin", skins);
    if (!assets.clips.empty()) {
        fmt::print("{}\n", counted(assets.clips.size(), "clip"));
    }
    for (std::size_t i = 0; i < std::min(assets.clips.size(), kMaxLines); ++i) {
        const ClipData& clip = assets.clips[i];
        const std::string contacts =
            clip.contacts.empty() ? ""
                                  : fmt::format("  {}", counted(clip.contacts.size(), "contact"));
        fmt::print(
            "    {:>8.2f} s  {} numbers{}  {}\n", clip.duration, clip_size(clip), contacts,
            clip.name);
    }
    print_rest(assets.clips.size());
}

/// Needs OpenGL, which may be missing.
void print_programs(World& world, Entity camera) {
    Result<HeadlessRenderer> headless = create_headless_renderer();
    if (!headless) {
        fmt::print("shader programs not counted: {}\n", headless.error().message);
        return;
    }
    start_world(world, add_game_systems);
    const int programs = warm_up_world(*headless, world, camera, kProgramsSize);
    fmt::print("{}\n", counted(static_cast<std::size_t>(programs), "shader program"));
}

Status print_scene(const std::string& file) {
    World world;
    register_game_components();
    const Result<LoadedScene> scene = load_scene(world, file);
    if (!scene) {
        return scene.error();
    }
    fmt::print(
        "{}{}{}\n{}\n", scene->name, scene->title.empty() ? "" : ": ", scene->title, scene->path);
    if (!is_empty(scene->bounds)) {
        const Vec3 size = 2.0f * half_extent(scene->bounds);
        const Vec3 box_center = center(scene->bounds);
        fmt::print(
            "{:.3g} x {:.3g} x {:.3g} m about ({:.3g}, {:.3g}, {:.3g})\n", size.x, size.y, size.z,
            box_center.x, box_center.y, box_center.z);
    }
    if (scene->duration > 0.0) {
        fmt::print("camera path of {:.1f} s\n", scene->duration);
    }
    print_list("material variant", scene->variants);
    const std::vector<Entity> entities = own_entities(world, *scene);
    print_components(world, entities);
    print_cameras_and_lights(world, entities);
    print_particles(world, entities);
    print_hierarchy(world, entities);
    const Assets& assets = world.resource<Assets>();
    const ModelView view = scene->model.value_or(ModelView{});
    print_assets(
        assets, std::span(assets.meshes).first(assets.meshes.size() - view.meshes),
        std::span(assets.materials).first(assets.materials.size() - view.materials));
    print_programs(world, scene->camera);
    return Done{};
}

Status print_exr(const std::string& file) {
    const Result<ExrImage> image = read_exr(file);
    if (!image) {
        return image.error();
    }
    fmt::print(
        "{}\nOpenEXR, {} x {} pixels, {}\n", file, image->width, image->height,
        counted(image->channels.size(), "channel"));
    const ExrWindow& display = image->display;
    if (display.x != image->x || display.y != image->y || display.width != image->width
        || display.height != image->height) {
        fmt::print(
            "shown: {} x {} pixels from ({}, {}), of which there are {} x {} from ({}, {})\n",
            display.width, display.height, display.x, display.y, image->width, image->height,
            image->x, image->y);
    }
    if (const std::string shown = describe_shown(*image); !shown.empty()) {
        fmt::print("{}\n", shown);
    }
    for (const ExrChannel& channel : image->channels) {
        float smallest = INFINITY;
        float largest = -INFINITY;
        for (const float value : channel.values) {
            smallest = std::min(smallest, value);
            largest = std::max(largest, value);
        }
        fmt::print(
            "    {:<16} {:<5} {:.6g} .. {:.6g}\n", channel.name, channel.half ? "half" : "float",
            smallest, largest);
    }
    for (const auto& [name, value] : image->metadata) {
        fmt::print("    {} = {}\n", name, value);
    }
    return Done{};
}

/// "BC7 (sRGB), 10 mip levels, 341.5 KiB: 25.0 % of RGBA8"
std::string describe_blocks(const ImageData& image) {
    ImageData unpacked = {.name = {}, .width = image.width, .height = image.height, .pixels = {}};
    unpacked.mip_levels = image.mip_levels;
    const auto bytes = static_cast<double>(image_bytes(image));
    return fmt::format(
        "{}{}, {}, {:.1f} KiB: {:.1f} % of RGBA8", format_name(image.format),
        image.srgb ? " (sRGB)" : "",
        counted(static_cast<std::size_t>(image.mip_levels), "mip level"), bytes / 1024,
        100 * bytes / static_cast<double>(image_bytes(unpacked)));
}

Status print_image(const std::string& file) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(file));
    const ImageData image = LIMN_TRY(
        is_dds_file(bytes) ? decode_dds(bytes, file, {}) : decode_image(bytes, file, true));
    static constexpr const char* kFormats[] = {"8 bit", "half", "float"};
    fmt::print(
        "{}\n{} x {} pixels, {}\n", file, image.width, image.height,
        is_in_blocks(image.format) ? describe_blocks(image)
                                   : kFormats[static_cast<std::size_t>(image.format)]);
    return Done{};
}

/// The answers of viewers to the level relax.
Status print_trials(const std::string& file) {
    const std::vector<TrialRecord> records = LIMN_TRY(load_trials(file));
    fmt::print("{} viewers\n{}", records.size(), describe_tally(tally_trials(records)));
    return Done{};
}

/// Names of the markers, and how long each is hidden.
Status print_markers(const std::string& file) {
    const MarkerMotion motion = LIMN_TRY(load_trc(file));
    fmt::print(
        "{:.2f} s, {} at {:.6g} per second\n",
        static_cast<double>(motion.frames() - 1) / static_cast<double>(motion.rate),
        counted(motion.frames(), "frame"), motion.rate);
    std::vector<std::string> lines;
    for (std::size_t m = 0; m < motion.markers(); ++m) {
        std::size_t hidden = 0;
        for (std::size_t f = 0; f < motion.frames(); ++f) {
            hidden += is_finite(motion.positions[f * motion.markers() + m]) ? 0 : 1;
        }
        lines.push_back(
            hidden == 0
                ? motion.names[m]
                : fmt::format(
                    "{}  hidden in {:.0f} % of the frames", motion.names[m],
                    100.0 * static_cast<double>(hidden) / static_cast<double>(motion.frames())));
    }
    print_list("marker", lines);
    return Done{};
}

}  // namespace

Status run_info(const std::string& file) {
    const std::string extension = extension_of(file);
    if (extension == ".exr") {
        return print_exr(file);
    }
    if (extension == ".csv") {
        return print_trials(file);
    }
    static constexpr std::array<std::string_view, 7> kImages = {".png",  ".jpg", ".jpeg", ".bmp",
                                                                ".webp", ".hdr", ".dds"};
    if (std::find(kImages.begin(), kImages.end(), extension) != kImages.end()) {
        return print_image(file);
    }
    if (extension == ".trc") {
        return print_markers(file);
    }
    return print_scene(file);
}

}  // namespace limn
