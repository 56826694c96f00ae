#include "content/app/panels/furrow_edits.h"

#include "content/bake/furrow_presets.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "content/load/level/component_json.h"
#include "ecs/base/check.h"
#include "ecs/base/triangle.h"
#include "ecs/components/surface.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

// Techniques: wrinkle.furrow.editor

namespace limn {
namespace {

constexpr float kHidden =
    1e-4f;  // fraction of the distance by which an occluder must be nearer than the vertex
constexpr float kGrazing =
    0.02f;  // sine of the angle below which a ray counts as parallel to a plane

/// The fitted BRDFs were never published: sets of lobes of the same kind.
struct LobeSet {
    Vec3 diffuse;
    float across[2];
    float along[2];
    float exponent[2];
};
constexpr LobeSet kLobeSets[] = {
    {{0.60f, 0.42f, 0.33f}, {-0.95f, -0.55f}, {0.95f, 0.45f}, {20, 4}},
    {{0.40f, 0.26f, 0.19f}, {-0.98f, -0.60f}, {0.98f, 0.50f}, {40, 5}},
};

bool is_hidden(const ViewedMesh& viewed, const Vec3& point) {
    const MeshData& mesh = *viewed.mesh;
    const Vec3 offset = point - viewed.eye;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto corner = [&](std::size_t k) { return mesh.positions[mesh.indices[i + k]]; };
        const auto hit = hit_triangle(viewed.eye, offset, corner(0), corner(1), corner(2));
        if (hit && hit->distance < 1.0f - kHidden) {
            return true;
        }
    }
    return false;
}

}  // namespace

std::optional<Vec2> pixel_of(const ViewedMesh& viewed, const Vec3& point) {
    const Vec4 clip = viewed.clip_from_mesh * Vec4(point, 1);
    if (!(clip.w > 0)) {
        return std::nullopt;
    }
    return viewed.size * (0.5f + Vec2(0.5f, -0.5f) * Vec2(clip) / clip.w);
}

Ray ray_of(const ViewedMesh& viewed, const Vec2& pixel) {
    const Vec2 ndc = Vec2(2, -2) * pixel / viewed.size + Vec2(-1, 1);
    const Vec4 near = glm::inverse(viewed.clip_from_mesh) * Vec4(ndc, 1, 1);  // depth is reversed
    return {viewed.eye, normalize_or(Vec3(near) / near.w - viewed.eye, {0, 0, -1})};
}

std::optional<std::uint32_t>
pick_furrow_vertex(const ViewedMesh& viewed, const Vec2& pointer, float pick_radius) {
    struct Near {
        float pixels;
        std::uint32_t vertex;
    };
    const MeshData& mesh = *viewed.mesh;
    std::vector<Near> near;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const auto pixel = pixel_of(viewed, mesh.positions[v]);
        if (!pixel || !(glm::dot(mesh.normals[v], viewed.eye - mesh.positions[v]) > 0)) {
            continue;
        }
        if (const float pixels = glm::distance(*pixel, pointer); pixels <= pick_radius) {
            near.push_back({pixels, v});
        }
    }
    std::ranges::stable_sort(near, {}, &Near::pixels);
    const auto found = std::ranges::find_if(
        near, [&](const Near& n) { return !is_hidden(viewed, mesh.positions[n.vertex]); });
    return found != near.end() ? std::optional(found->vertex) : std::nullopt;
}

std::optional<int> pick_furrow_tip(
    const ViewedMesh& viewed, const Vec3& position, const FurrowVectors& vectors, float length,
    const Vec2& pointer, float pick_radius) {
    std::optional<int> found;
    float least = pick_radius;
    for (int f = 0; f < 2; ++f) {
        const auto pixel =
            pixel_of(viewed, position + length * vectors[static_cast<std::size_t>(f)]);
        const float pixels = pixel ? glm::distance(*pixel, pointer) : INFINITY;
        if (pixels < least || (!found && pixels <= least)) {
            least = pixels;
            found = f;
        }
    }
    return found;
}

Vec3 drag_furrow_tip(const Vec3& position, const Vec3& normal, float length, const Ray& ray) {
    LIMN_CHECK(length > 0);
    const float sine = glm::dot(ray.direction, normal);
    const Vec3 from = position - ray.origin;
    const float distance =
        std::abs(sine) > kGrazing ? glm::dot(from, normal) / sine : glm::dot(from, ray.direction);
    const Vec3 offset = (distance * ray.direction - from) / length;
    const Vec3 tangent = offset - glm::dot(offset, normal) * normal;
    const float magnitude = glm::length(tangent);
    return tangent * (magnitude > kMaxFurrowMagnitude ? kMaxFurrowMagnitude / magnitude : 1.0f);
}

std::optional<std::size_t>
find_furrow_arrow(const FurrowSkin& skin, const MeshData& mesh, std::uint32_t vertex) {
    for (std::size_t i = skin.edited.size(); i-- > 0;) {
        if (mesh.positions[skin.edited[i]] == mesh.positions[vertex]) {
            return i;
        }
    }
    return std::nullopt;
}

FurrowArrow& edit_furrow_vertex(
    Furrows& furrows, const FurrowSkin& skin, const MeshData& mesh, std::uint32_t vertex) {
    if (const auto known = find_furrow_arrow(skin, mesh, vertex);
        known && *known < furrows.arrows.size()) {
        return furrows.arrows[*known];
    }
    const FurrowVectors& shown = skin.field[vertex];
    return furrows.arrows.emplace_back(FurrowArrow{mesh.positions[vertex], shown[0], shown[1]});
}

void initialize_furrows(Furrows& furrows) {
    furrows.arrows.clear();
    furrows.hold.spread.clear();
}

void let_furrows_wait(Furrows& furrows, bool wait) {
    furrows.hold =
        wait ? FurrowHold{true, furrows.arrows, furrows.arrows, furrows.style} : FurrowHold{};
}

void interpolate_furrows(Furrows& furrows) {
    if (furrows.hold.waits) {
        furrows.hold.spread = furrows.arrows;
    }
}

void generate_furrows(Furrows& furrows) {
    if (furrows.hold.waits) {
        furrows.hold.grown = furrows.hold.spread;
        furrows.hold.style = furrows.style;
    }
}

void remake_furrows(Furrows& furrows) {
    if (furrows.hold.waits) {
        furrows.hold.style.noise = furrows.style.noise;
        furrows.hold.style.bump = furrows.style.bump;
    }
}

FurrowLook furrow_look_of(const Material& material) {
    FurrowLook look = {
        .melanin = material.melanin,
        .blood = material.blood,
        .specular = material.specular.x,
        .shininess = material.shininess};
    if (material.shading == ShadingModel::Lafortune) {
        look.reflection = Vec3(material.base_color) == kLobeSets[1].diffuse
                              ? FurrowReflection::Brdf2
                              : FurrowReflection::Brdf1;
    }
    return look;
}

void set_furrow_look(Material& material, const FurrowLook& look) {
    material.melanin = look.melanin;
    material.blood = look.blood;
    material.specular = Vec3(look.specular);
    material.shininess = std::max(look.shininess, 1.0f);
    if (look.reflection == FurrowReflection::Own) {
        material.shading = ShadingModel::Skin;
        material.pigments = Pigments::Plane;
        material.base_color = {1, 1, 1, material.base_color.w};
        material.skin_color = {0, 0, 0};  // Bando's model has no rim light
        return;
    }
    const LobeSet& lobes = kLobeSets[look.reflection == FurrowReflection::Brdf1 ? 0 : 1];
    material.shading = ShadingModel::Lafortune;
    material.pigments = Pigments::None;
    material.base_color = Vec4(lobes.diffuse, material.base_color.w);
    material.lobes.clear();
    for (std::size_t i = 0; i < 2; ++i) {
        material.lobes.push_back(
            {Vec3(lobes.across[i]), Vec3(lobes.along[i]), Vec3(lobes.exponent[i])});
    }
}

void set_furrow_preset(Furrows& furrows, FurrowLook& look, const FurrowPreset& preset) {
    furrows.style = with_preset(furrows.style, preset);
    switch (preset.lighting) {
    case FurrowLighting::Blinn:
        look = {
            FurrowReflection::Own, preset.melanin, preset.blood, preset.specular, preset.shininess};
        break;
    case FurrowLighting::Brdf1:
        look.reflection = FurrowReflection::Brdf1;
        break;
    case FurrowLighting::Brdf2:
        look.reflection = FurrowReflection::Brdf2;
        break;
    }
}

Status save_furrows(const std::string& path, const FurrowFile& file) {
    JsonValue furrows = write_component(component_info<Furrows>(), &file.furrows, {});
    std::erase_if(furrows.members, [](const JsonMember& member) {
        return member.key == "normals" || member.key == "heights" || member.key == "hold";
    });
    JsonValue skin = write_component(component_info<FurrowLook>(), &file.skin, {});
    const JsonValue root =
        json_object({{"furrows", {}, std::move(furrows)}, {"skin", {}, std::move(skin)}});
    return write_file(path, write_json(root) + "\n");
}

Result<FurrowFile> load_furrows(const std::string& path) {
    const JsonValue json = LIMN_TRY(load_json(path));
    const JsonLocation location = {path, ""};
    constexpr std::string_view kKeys[] = {"furrows", "skin"};
    LIMN_TRY(expect_keys(json, location, kKeys));
    FurrowFile file;
    if (const JsonValue* const furrows = json.find("furrows")) {
        LIMN_TRY(read_struct(*furrows, file.furrows, location_in(location, "furrows"), {}));
    }
    if (const JsonValue* const skin = json.find("skin")) {
        LIMN_TRY(read_struct(*skin, file.skin, location_in(location, "skin"), {}));
    }
    file.furrows.hold = {};
    return file;
}

}  // namespace limn
