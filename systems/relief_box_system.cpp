#include "systems/relief_box_system.h"

#include "ecs/base/hash.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

// Techniques: relief.multi-face, relief.slices, relief.slices-lod, relief.slices-view

namespace limn {
namespace {

/// Axes of the map of a side, as baked (BoxFace, tile_surface.h), and toward its viewer.
struct MapAxes {
    Vec3 right;
    Vec3 up;
    Vec3 toward;
};

constexpr MapAxes kMapAxes[kReliefFaces] = {
    {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
};

const MapAxes& map_axes(ReliefFace face) {
    return kMapAxes[static_cast<std::size_t>(face)];
}

constexpr std::uint32_t bit_of(ReliefFace face) {
    return 1u << static_cast<unsigned>(face);
}

constexpr ReliefFace kSides[kReliefFaces] = {ReliefFace::Right, ReliefFace::Left,
                                             ReliefFace::Top,   ReliefFace::Bottom,
                                             ReliefFace::Front, ReliefFace::Back};

void add_polygon(MeshData& mesh, const MapAxes& axes, const std::vector<Vec3>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : corners) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(axes.toward);
        mesh.tangents.emplace_back(axes.right, 1.0f);
        mesh.uvs.emplace_back(0.5f + glm::dot(p, axes.right), 0.5f - glm::dot(p, axes.up));
        mesh.uvs1.emplace_back(0.5f - glm::dot(p, axes.toward), 0.0f);
    }
    for (std::uint32_t i = 2; i < corners.size(); ++i) {
        mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
    }
}

/// A side, or a plane parallel to it, `depth` below.
std::vector<Vec3> side_at(const MapAxes& axes, float depth) {
    const Vec3 center = (0.5f - depth) * axes.toward;
    const Vec3 right = 0.5f * axes.right;
    const Vec3 up = 0.5f * axes.up;
    return {center - right - up, center + right - up, center + right + up, center - right + up};
}

MeshData empty_mesh() {
    MeshData mesh;
    mesh.name = "relief box";
    mesh.bounds = {Vec3(-0.5f), Vec3(0.5f)};
    return mesh;
}

/// Cuts a convex polygon where sign * p[axis] > 0.5 (Sutherland and Hodgman 1974).
std::vector<Vec3> cut_polygon(const std::vector<Vec3>& corners, int axis, float sign) {
    std::vector<Vec3> left;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3& a = corners[i];
        const Vec3& b = corners[(i + 1) % corners.size()];
        const float over_a = sign * a[axis] - 0.5f;
        const float over_b = sign * b[axis] - 0.5f;
        if (over_a <= 0) {
            left.push_back(a);
        }
        if ((over_a < 0 && over_b > 0) || (over_a > 0 && over_b < 0)) {
            Vec3 p = glm::mix(a, b, over_a / (over_a - over_b));
            p[axis] = 0.5f * sign;
            left.push_back(p);
        }
    }
    return left;
}

/// dot(p, normal) = distance within the unit box; less than three corners: it only touches the box.
std::vector<Vec3> plane_in_box(const Vec3& normal, float distance) {
    const Vec3 unit = glm::normalize(normal);
    const Vec3 right = 2.0f * any_perpendicular(unit);
    const Vec3 up = glm::cross(unit, right);
    const Vec3 center = unit * (distance / glm::length(normal));
    std::vector<Vec3> corners = {
        center - right - up, center + right - up, center + right + up, center - right + up};
    for (int axis = 0; axis < 3; ++axis) {
        corners = cut_polygon(cut_polygon(corners, axis, 1), axis, -1);
    }
    return corners;
}

MaterialId box_map(const ReliefBox& box, ReliefFace face) {
    switch (face) {
    case ReliefFace::Right:
        return box.right;
    case ReliefFace::Left:
        return box.left;
    case ReliefFace::Top:
        return box.top;
    case ReliefFace::Bottom:
        return box.bottom;
    case ReliefFace::Back:
        return box.back;
    case ReliefFace::Front:
        break;
    }
    return box.front;
}

/// The sides that show the map of `face`: 0 if it has none.
std::uint32_t sides_of(const ReliefBox& box, ReliefFace face, const Assets& assets) {
    const auto exists = [&](ReliefFace side) {
        return box_map(box, side).index < assets.materials.size();
    };
    if (!exists(face)) {
        return 0;
    }
    std::uint32_t sides = bit_of(face);
    for (const ReliefFace side : kSides) {
        sides |= face == ReliefFace::Front && !exists(side) ? bit_of(side) : 0;
    }
    return box.hide_bottom ? sides & ~bit_of(ReliefFace::Bottom) : sides;
}

void put_mesh(Assets& assets, MeshId& id, MeshData mesh) {
    if (id.index >= assets.meshes.size()) {
        id.index = static_cast<std::uint32_t>(assets.meshes.size());
        assets.meshes.push_back(std::move(mesh));
        return;
    }
    mesh.version = assets.meshes[id.index].version + 1;
    assets.meshes[id.index] = std::move(mesh);
}

/// Copies `source` for a part; true if it replaces an older copy. Parts have no use for the depth
/// of the relief, that of their box: it is how far casters are moved away from their light.
bool put_material(Assets& assets, MaterialId& id, MaterialId source, bool sliced, float set_back) {
    Material copy = assets.materials[source.index];
    const bool closed = copy.detail == SurfaceDetail::DoubleDepth;
    copy.name += " in a box";
    copy.detail = sliced   ? closed ? kClosedReliefSlicesDetail : kReliefSlicesDetail
                  : closed ? kClosedReliefBoxDetail
                           : kReliefBoxDetail;
    copy.relief_shadow = ReliefShadow::Map;
    copy.relief_depth = set_back;
    for (TextureSlot* slot : {&copy.relief_texture, &copy.base_color_texture}) {
        slot->wrap_u = Wrap::Clamp;
        slot->wrap_v = Wrap::Clamp;
    }
    if (id.index < assets.materials.size()) {
        assets.materials[id.index] = std::move(copy);
        return true;
    }
    id.index = static_cast<std::uint32_t>(assets.materials.size());
    assets.materials.push_back(std::move(copy));
    return false;
}

/// Extent of the box across the planes of a map, in the image [px].
float depth_pixels(
    const ReliefBox& box, const Affine& world, const Vec3& eye, const Camera& camera, float rows) {
    const Vec3 center = {world.row[0].w, world.row[1].w, world.row[2].w};
    const float depth = glm::length(transform_vector(world, Vec3(0, 0, box.size.z)));
    const float distance = std::max(glm::length(center - eye), 1e-6f);
    const float height = camera.ortho_height > 0 ? camera.ortho_height
                                                 : 2 * distance * std::tan(0.5f * camera.fov_y);
    return depth / height * rows;
}

/// The camera in the space of a unit box.
struct BoxView {
    Vec3 eye;
    Vec3 toward;  ///< normal of planes that face the camera
};

BoxView view_of(const Affine& unit_box, const Affine& camera, bool orthographic) {
    const Mat4 inverse = glm::inverse(to_mat4(unit_box));
    const Vec3 back = {camera.row[0].z, camera.row[1].z, camera.row[2].z};
    const Vec3 at = {camera.row[0].w, camera.row[1].w, camera.row[2].w};
    const Vec4 eye = {at + (orthographic ? 1e6f : 0.0f) * back, 1};
    // A plane dot(x, n) = c is dot(M p, n) = c, so its normal there is transpose(M) n.
    const auto& m = unit_box.row;
    return {Vec3(inverse * eye), back.x * Vec3(m[0]) + back.y * Vec3(m[1]) + back.z * Vec3(m[2])};
}

std::uint64_t hash_of_view(const Vec3& normal, std::uint64_t seed) {
    return hash_bytes(&normal, sizeof normal, seed);
}

void update_slices(
    const ReliefBox& box, ReliefFace face, std::uint32_t faces, int count, const Vec3& toward,
    ReliefBoxPart& part, Assets& assets) {
    const bool by_view = box.slices == ReliefSlices::View;
    const bool shown = (faces & (by_view ? sides_of(box, face, assets) : bit_of(face))) != 0;
    const std::uint64_t made_of = !shown ? 1
                                  : by_view
                                      ? hash_of_view(toward, static_cast<std::uint64_t>(count))
                                      : static_cast<std::uint64_t>(count) << 1;
    if (part.made_of != made_of) {
        part.made_of = made_of;
        put_mesh(
            assets, part.mesh,
            !shown    ? empty_mesh()
            : by_view ? make_view_slices(face, toward, count)
                      : make_face_slices(face, count));
        const float own = std::popcount(sides_of(box, face, assets)) == 1 ? 1.0f : 0.0f;
        for (Vec2& uv : assets.meshes[part.mesh.index].uvs1) {
            uv.y = own;
        }
    }
}

/// Whether it replaced materials.
bool update_parts(
    const ReliefBox& box, ReliefBoxState& state, const BoxView& view, float scale, Assets& assets) {
    const Vec3 size = box.size;
    const float set_back = state.slice_count > 0 ? 2 * std::max({size.x, size.y, size.z}) * scale
                                                       / static_cast<float>(state.slice_count)
                                                 : 0;
    const bool stale = state.material_version != assets.material_version
                       || std::exchange(state.set_back, set_back) != set_back;
    bool replaced = false;
    for (const ReliefFace face : kSides) {
        const auto i = static_cast<std::size_t>(face);
        const std::uint32_t sides = sides_of(box, face, assets);
        const MaterialId map = box_map(box, face);
        ReliefBoxPart& part = state.searched[i];
        const std::uint64_t made_of = sides == 0 ? 0 : std::uint64_t{map.index} << 32 | sides;
        const bool remade = part.made_of != made_of;
        if (remade) {
            part.made_of = made_of;
            put_mesh(assets, part.mesh, make_box_sides(face, sides));
            state.sliced[i].made_of = 0;
        }
        if (sides == 0) {
            state.sliced[i].mesh = {};
            continue;
        }
        if (remade || stale) {
            replaced = put_material(assets, part.material, map, false, set_back) || replaced;
        }
        if (box.slices != ReliefSlices::None) {
            if (remade || stale || state.sliced[i].material == MaterialId{}) {
                replaced = put_material(assets, state.sliced[i].material, map, true, 0) || replaced;
            }
            update_slices(
                box, face, state.faces, state.slice_count, view.toward, state.sliced[i], assets);
        }
    }
    return replaced;
}

}  // namespace

std::uint32_t facing_sides(const Vec3& eye, const Vec3& half_size) {
    std::uint32_t sides = 0;
    for (const ReliefFace side : kSides) {
        const Vec3 toward = map_axes(side).toward;
        sides |= glm::dot(toward, eye) > glm::dot(glm::abs(toward), half_size) ? bit_of(side) : 0;
    }
    return sides;
}

int choose_slice_count(float pixels, int current, int least, int most) {
    const auto count_for = [&](float wanted) {
        const float whole = std::ceil(std::clamp(wanted, 1.0f, 1e6f));
        const auto count = static_cast<int>(std::bit_ceil(static_cast<unsigned>(whole)));
        return std::clamp(count, least, std::max(least, most));
    };
    const int wanted = count_for(pixels);
    if (current <= 0) {
        return wanted;
    }
    return wanted > current ? std::max(count_for(pixels / 1.2f), current)
                            : std::min(count_for(pixels * 1.2f), current);
}

MeshData make_box_sides(ReliefFace map, std::uint32_t sides) {
    MeshData mesh = empty_mesh();
    for (const ReliefFace side : kSides) {
        if ((sides & bit_of(side)) != 0) {
            add_polygon(mesh, map_axes(map), side_at(map_axes(side), 0));
        }
    }
    return mesh;
}

MeshData make_face_slices(ReliefFace map, int count) {
    MeshData mesh = empty_mesh();
    for (int k = count; k >= 1; --k) {
        const float depth = static_cast<float>(k) / static_cast<float>(count);
        add_polygon(mesh, map_axes(map), side_at(map_axes(map), depth));
    }
    return mesh;
}

MeshData make_view_slices(ReliefFace map, const Vec3& normal, int count) {
    MeshData mesh = empty_mesh();
    const float reach = 0.5f * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
    for (int k = count; k >= 1; --k) {
        const float depth = static_cast<float>(k) / static_cast<float>(count);
        const std::vector<Vec3> corners = plane_in_box(normal, reach * (1 - 2 * depth));
        if (corners.size() >= 3) {
            add_polygon(mesh, map_axes(map), corners);
        }
    }
    return mesh;
}

void add_relief_box_states(
    Query<const ReliefBox, Without<ReliefBoxState>> boxes, Commands commands) {
    boxes.each([&](Entity entity, const ReliefBox&) { commands.add(entity, ReliefBoxState{}); });
}

void update_relief_boxes(
    Query<const ReliefBox, const WorldTransform, ReliefBoxState> boxes,
    Query<const Camera, const WorldTransform> cameras, OptionalRes<const Rendering> rendering,
    Res<Assets> assets) {
    const Camera* active = nullptr;
    Affine pose = affine_from({0, 0, 0}, {1, 0, 0, 0}, {1, 1, 1});
    cameras.each([&](const Camera& camera, const WorldTransform& transform) {
        if (camera.active && active == nullptr) {
            active = &camera;
            pose = transform.world;
        }
    });
    const Camera camera = active != nullptr ? *active : Camera{};
    const float rows = rendering ? rendering->level_rows : Rendering{}.level_rows;
    bool replaced = false;
    bool any = false;
    boxes.each([&](const ReliefBox& box, const WorldTransform& transform, ReliefBoxState& state) {
        const Affine unit_box =
            transform.world * affine_from({0, 0, 0}, {1, 0, 0, 0}, glm::max(box.size, Vec3(1e-4f)));
        const BoxView view = view_of(unit_box, pose, camera.ortho_height > 0);
        state.faces = facing_sides(view.eye, Vec3(0.5f));
        if (box.hide_bottom) {
            state.faces &= ~bit_of(ReliefFace::Bottom);
        }
        const Vec3 eye = {pose.row[0].w, pose.row[1].w, pose.row[2].w};
        const float pixels = depth_pixels(box, transform.world, eye, camera, rows);
        const bool sliced = box.slices != ReliefSlices::None && std::isfinite(pixels)
                            && glm::dot(view.toward, view.toward) > 0;
        state.slice_count =
            sliced ? choose_slice_count(
                pixels / std::max(box.slice_pixels, 0.01f), state.slice_count,
                std::clamp(box.min_slices, 1, 1024), std::clamp(box.max_slices, 1, 1024))
                   : 0;
        const float scale = glm::length(transform_vector(transform.world, Vec3(0, 0, 1)));
        replaced = update_parts(box, state, view, scale, *assets) || replaced;
        any = true;
    });
    if (any) {
        assets->material_version += replaced ? 1 : 0;
        boxes.each([&](const ReliefBox&, const WorldTransform&, ReliefBoxState& state) {
            state.material_version = assets->material_version;
        });
    }
}

}  // namespace limn
