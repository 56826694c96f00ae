#include "bench/faces/face_crowd.h"
#include "bench/faces/face_rows.h"
#include "ecs/base/jobs.h"
#include "ecs/components/weld.h"
#include "systems/animation/deformer_kernels.h"
#include "systems/animation/patch_kernels.h"
#include "systems/animation/skin_kernels.h"
#include "systems/animation/surface_patches.h"
#include "systems/faces/skin_strain.h"
#include "systems/faces/wrinkle_measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace limn::bench {
namespace {

constexpr double kMeasureLimit = 4;  ///< of 100 faces [ms]
constexpr double kDeformLimit = 12;  ///< the same

/// find_intensities_scalar on all threads.
void measure_scalar(
    std::span<const WrinkleRest> rests, std::span<const CrowdFace> faces,
    std::span<const float> resting = {}) {
    parallel_for(faces.size(), 1, [&](std::size_t begin, std::size_t end) {
        find_intensities_scalar(rests, faces.subspan(begin, end - begin), resting);
    });
}

void add_measure_row(
    FaceBench& bench, std::string name, std::span<const WrinkleRest> rests, double limit,
    std::span<const float> resting = {}) {
    const std::vector<CrowdFace> faces = crowd_faces(face_crowd(), kCrowd);
    const auto [ours, scalar] = race(
        bench.repeats, [&] { find_intensities(rests, faces, resting); },
        [&] { measure_scalar(rests, faces, resting); });
    bench.add(FaceRow{std::move(name), ours, scalar, "scalar", limit});
}

/// Meshes that are equal but at different addresses.
void add_identities_row(FaceBench& bench) {
    const std::vector<CrowdFace> faces = crowd_faces(face_crowd(), kCrowd);
    const std::vector<std::vector<WrinkleRest>> meshes(kIdentities, face_crowd().chord);
    const auto run = [&](const auto& measure) {
        parallel_for(meshes.size(), 1, [&](std::size_t i, std::size_t) {
            const std::size_t begin = i * kCrowd / kIdentities;
            const std::size_t end = (i + 1) * kCrowd / kIdentities;
            measure(
                meshes[i], std::span(faces).subspan(begin, end - begin), std::span<const float>());
        });
    };
    const auto [ours, scalar] = race(
        bench.repeats, [&] { run(find_intensities); }, [&] { run(find_intensities_scalar); });
    bench.add(FaceRow{
        fmt::format("compression and intensities, {} identities", kIdentities), ours, scalar,
        "scalar", kMeasureLimit});
}

void add_strain_rows(FaceBench& bench) {
    const FaceCrowd& crowd = face_crowd();
    const SkinTriangles skin = make_skin_triangles(crowd.mesh.positions, crowd.mesh.indices);
    std::vector<SkinStrain> triangles(skin.area.size());
    std::vector<SkinStrain> vertices(crowd.mesh.positions.size());
    const auto [strain, weld] = race(
        std::min(bench.repeats, 20),
        [&] {
            find_strain(skin, crowd.members[0].deformed, triangles);
            average_strain(skin, triangles, vertices);
        },
        [&] { (void)weld_positions(crowd.mesh.positions); });
    bench.add(FaceRow{"Cauchy strain of one face, scalar", strain});
    bench.add(FaceRow{"weld of one mesh, once", weld});
}

/// Markers instead of shapes and joints: patches through them, and the faces bound to these.
void add_patch_row(FaceBench& bench, FaceCrowd& crowd) {
    const auto move_by = [&](const auto& move) {
        parallel_for(kCrowd, 1, [&](std::size_t i, std::size_t) {
            CrowdMember& member = crowd.members[i];
            make_patches(member.markers, crowd.on_markers.corners, member.patches);
            member.deformed = crowd.mesh.positions;
            move(surface_shape(&crowd.on_markers, member.patches), member.deformed);
        });
    };
    const auto [patches, scalar] = race(
        bench.repeats, [&] { move_by(move_by_patches); }, [&] { move_by(move_by_patches_scalar); });
    bench.add(FaceRow{
        fmt::format("{} patches through markers", crowd.on_markers.corners.size() / 3), patches,
        scalar, "scalar", kDeformLimit});
}

}  // namespace

void add_measure_rows(FaceBench& bench) {
    const FaceCrowd& crowd = face_crowd();
    add_measure_row(bench, "compression and intensities", crowd.chord, kMeasureLimit);
    add_measure_row(
        bench, "the same, folds that stay at rest", crowd.chord, kMeasureLimit, crowd.resting);
    add_identities_row(bench);
    const std::vector<Vec3> up(crowd.mesh.positions.size(), Vec3{0, 1, 0});
    const std::vector<WrinkleRest> everywhere = {
        make_wrinkle_rest(crowd.mesh.positions, crowd.mesh.indices, up)};
    add_measure_row(bench, "compression and intensities, scalp and neck too", everywhere, 0);
    add_measure_row(bench, "strain, shortest direction, intensities", crowd.strain, 0);
    add_strain_rows(bench);
}

void add_deform_rows(FaceBench& bench) {
    FaceCrowd& crowd = face_crowd();
    const auto each = [&](const auto& run) {
        parallel_for(kCrowd, 1, [&](std::size_t i, std::size_t) {
            CrowdMember& member = crowd.members[i];
            member.deformed = crowd.mesh.positions;
            run(member);
        });
    };
    const auto nothing = [](CrowdMember&) {};
    const auto morph = [&](CrowdMember& member) {
        add_morphs(crowd.mesh.morphs, member.morphs.weights, {member.deformed, {}, {}});
    };
    const auto [morphs, copy] = race(
        bench.repeats, [&] { each(morph); }, [&] { each(nothing); });
    bench.add(FaceRow{"morph targets", morphs, copy, "copy of positions"});

    const auto pull = [](CrowdMember& member) {
        deform_points(member.deformers.now, member.deformed);
    };
    const auto pull_scalar = [](CrowdMember& member) {
        deform_points_scalar(member.deformers.now, member.deformed);
    };
    const auto [muscles, muscles_scalar] = race(
        std::min(bench.repeats, 20), [&] { each(pull); }, [&] { each(pull_scalar); });
    bench.add(FaceRow{"8 muscles, a sphincter, a lattice", muscles, muscles_scalar, "scalar"});

    const auto skin_by = [&](const auto& skin) {
        each([&](CrowdMember& member) {
            Affine palette[8];
            const std::span<Affine> joints = std::span(palette).first(crowd.skin.joints.size());
            compute_skin_palette(crowd.skin, member.pose.joints, joints);
            skin(
                crowd.mesh.skin, joints, RestVertices{member.deformed, {}, {}},
                SkinnedVertices{member.deformed, {}, {}}, 0, member.deformed.size());
        });
    };
    const auto [joints, joints_scalar] = race(
        bench.repeats, [&] { skin_by(skin_linear); }, [&] { skin_by(skin_linear_scalar); });
    bench.add(FaceRow{
        fmt::format("{} joints", crowd.skin.joints.size()), joints, joints_scalar, "scalar"});

    add_patch_row(bench, crowd);

    const auto [all, all_scalar] = race(
        std::min(bench.repeats, 30), [&] { deform_crowd(crowd, kCrowd); },
        [&] { deform_crowd_scalar(crowd, kCrowd); });
    bench.add(FaceRow{"all deformers", all, all_scalar, "scalar", kDeformLimit});
}

void add_face_growth(FaceBench& bench) {
    FaceCrowd& crowd = face_crowd();
    constexpr std::size_t kCounts[] = {1, 2, 5, 10, 20, 50, 100};
    std::vector<FaceGrowthPoint> points[4];
    for (const std::size_t count : kCounts) {
        const int repeats =
            std::min(bench.repeats, static_cast<int>(std::max<std::size_t>(400 / count, 5)));
        const std::vector<CrowdFace> faces = crowd_faces(crowd, count);
        const double per_face = 1e6 / static_cast<double>(count);
        const auto [deform, deform_scalar] = race(
            repeats, [&] { deform_crowd(crowd, count); },
            [&] { deform_crowd_scalar(crowd, count); });
        const auto [measure, scalar] = race(
            repeats, [&] { find_intensities(crowd.chord, faces); },
            [&] { measure_scalar(crowd.chord, faces); });
        points[0].push_back({"compression and intensities", count, measure * per_face});
        points[1].push_back({"compression and intensities, scalar", count, scalar * per_face});
        points[2].push_back({"all deformers", count, deform * per_face});
        points[3].push_back({"all deformers, scalar", count, deform_scalar * per_face});
    }
    for (const std::vector<FaceGrowthPoint>& curve : points) {
        for (const FaceGrowthPoint& point : curve) {
            bench.add(point);
        }
    }
}

}  // namespace limn::bench
