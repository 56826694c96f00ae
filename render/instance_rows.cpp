#include "render/instance_rows.h"

namespace limn {
namespace {

float determinant(const Affine& a) {
    const auto& r = a.row;
    return r[0].x * (r[1].y * r[2].z - r[1].z * r[2].y)
           - r[0].y * (r[1].x * r[2].z - r[1].z * r[2].x)
           + r[0].z * (r[1].x * r[2].y - r[1].y * r[2].x);
}

}  // namespace

void fill_boxes(
    const InstanceRows& rows, float alpha, const std::vector<MeshRange>& meshes, BoxBlock& boxes,
    std::uint8_t* mirrored) {
    for (std::size_t i = 0; i < rows.now.size(); ++i) {
        const std::uint32_t mesh = rows.surfaces[i].mesh.index;
        Bounds box;
        float det = 1;
        if (mesh < meshes.size() && meshes[mesh].index_count > 0) {
            const Affine a = rows.at(i, alpha);
            box = transform_bounds(a, rows.bounds(i, meshes));
            det = determinant(a);
        }
        const Vec3 c = center(box);
        const Vec3 h = half_extent(box);
        const float sum = c.x + c.y + c.z + h.x + h.y + h.z + det;
        const bool finite = std::abs(sum) < INFINITY;
        boxes.center_x[i] = finite ? c.x : 0.0f;
        boxes.center_y[i] = finite ? c.y : 0.0f;
        boxes.center_z[i] = finite ? c.z : 0.0f;
        boxes.half_x[i] = finite ? h.x : -1e30f;
        boxes.half_y[i] = finite ? h.y : -1e30f;
        boxes.half_z[i] = finite ? h.z : -1e30f;
        mirrored[i] = det < 0 ? 1 : 0;
    }
}

}  // namespace limn
