#pragma once

#include "bench/fakephong/fakephong_report.h"

#include <span>
#include <string>

namespace limn::fakephong {

// The tables of the page of fake Phong shading, each an HTML section; `results` are never empty.
// What they say in words is said of their numbers, and changes with them.

/// Table 6.1, as printed and as measured, with how far the fitted scenes are from the print.
[[nodiscard]] std::string correctness_section(std::span<const SceneResult> results);
/// The fitted teapot with textures of several sizes: which give the printed order.
[[nodiscard]] std::string texture_section();
/// By color correctness and by work.
[[nodiscard]] std::string ranking_section(std::span<const SceneResult> results);
/// Where the thesis contradicts itself, or these numbers it. Needs all its scenes.
[[nodiscard]] std::string contradiction_section(std::span<const SceneResult> results);
/// What each method saves and keeps today.
[[nodiscard]] std::string worth_section(std::span<const SceneResult> results);
/// Counted operations, per facet and per pixel; those of forward differences beside them.
[[nodiscard]] std::string work_section(const SceneResult& result);
/// Arcs, and the edges of the scenes, against polynomials.
[[nodiscard]] std::string path_section(std::span<const SceneResult> results);

/// Of shading_methods()[1 ..].
[[nodiscard]] const MethodResult& result_of(const SceneResult& scene, std::string_view id);
/// What the numbers say of a method today: "on fine meshes", say.
[[nodiscard]] std::string
verdict_of(const ShadingMethod& method, std::span<const SceneResult> results);
/// Of a frame, set-up included, as a share of Phong shading's.
[[nodiscard]] double work_share(const SceneResult& scene, const MethodResult& one);
[[nodiscard]] bool is_fine(const SceneResult& scene);  ///< more than a thousand facets

}  // namespace limn::fakephong
