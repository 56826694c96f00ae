#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn::oracle {

// Where the skin of a face folds in each expression, compared with anatomy: an expression shortens
// skin across the folds of its own regions, but not of other regions. Regions and directions are
// those of the mesh (content/bake/face_regions.h).

/// Morph targets of one expression: both halves of an action unit, or a single target.
struct FaceExpression {
    std::string name;  ///< "mouthSmile" of mouthSmile_L and mouthSmile_R
    std::string unit;  ///< of FACS without a side, "AU12"; or empty
    std::vector<std::uint32_t> morphs;
};

/// In the order of their first targets. Units are taken from the targets or derived from their
/// names.
[[nodiscard]] std::vector<FaceExpression> find_face_expressions(const MeshData& mesh);

/// Shortening of a region in an expression.
struct RegionFolding {
    double shortening =
        0;            ///< across its folds: mean over vertices, clamped at 0, by area and weight
    double left = 0;  ///< of x > 0
    double right = 0;
    double turn = 0;  ///< mean angle between `across` and the direction of maximum shortening [rad]
};

/// Shortening of every region of a mesh, prepared once.
class FaceFolding {
  public:
    explicit FaceFolding(const MeshData& mesh);
    ~FaceFolding();
    FaceFolding(const FaceFolding&) = delete;
    FaceFolding& operator=(const FaceFolding&) = delete;

    /// With these targets at `weight`. One element per region, in their order.
    [[nodiscard]] std::vector<RegionFolding>
    measure(std::span<const std::uint32_t> morphs, float weight = 1) const;

  private:
    struct Region;
    const MeshData& mesh_;
    std::vector<Region> regions_;
};

/// What anatomy predicts for an expression.
struct FoldingRule {
    std::string_view name;                 ///< "smile"
    std::vector<std::string_view> units;   ///< action units that make up the expression
    std::vector<std::string_view> folds;   ///< regions of which at least one folds
    std::vector<std::string_view> smooth;  ///< regions that do not fold
    bool dimples = false;  ///< demanded only of faces that model them: scans of a raised chin move
                           ///< its skin as a whole (ICT: chin 1.2 % shorter)
};
[[nodiscard]] std::span<const FoldingRule> folding_rules();

/// A rule applied to a face.
struct FoldingResult {
    double folding = 0;     ///< shortening of the region with the deepest folds
    double smooth = 0;      ///< maximum over regions that do not fold
    double difference = 0;  ///< relative difference between both sides of the folding region
};
/// False if the face lacks one of the units or all regions that fold.
[[nodiscard]] bool apply_rule(
    const FoldingRule& rule, const MeshData& mesh, const FaceFolding& folding,
    FoldingResult& result);

}  // namespace limn::oracle
