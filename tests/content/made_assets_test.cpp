#include "content/load/made_assets.h"
#include "content/make/find_kind.h"
#include "content/make/models/shapes.h"
#include "content/make/models/simplify_mesh.h"

#include <doctest/doctest.h>

namespace limn::made_assets_test {

TEST_CASE("made assets: a mesh made from another is kept until that one changes") {
    MadeAssets made;
    Assets assets;
    assets.meshes.push_back(make_sphere({.radius = 1, .segments = 24, .rings = 12}));
    const MeshKind& kind = *find_kind(mesh_kinds(), "simplified");
    const AnyComponent parameters =
        AnyComponent::of(SimplifiedShape{.mesh = {0}, .triangles = 100});

    const MeshData first = made.mesh(kind, parameters, assets).data;
    CHECK(made.mesh(kind, parameters, assets).data.positions == first.positions);
    CHECK(made.size() == 1);

    assets.meshes.push_back(assets.meshes[0]);  // of another name in the level, but the same
    const AnyComponent of_copy = AnyComponent::of(SimplifiedShape{.mesh = {1}, .triangles = 100});
    CHECK(made.mesh(kind, of_copy, assets).data.positions == first.positions);
    CHECK(made.size() == 1);

    assets.meshes[0].positions[0].y += 1;
    const MeshData changed = made.mesh(kind, parameters, assets).data;
    CHECK(changed.positions != first.positions);
    CHECK(made.size() == 2);
}

}  // namespace limn::made_assets_test
