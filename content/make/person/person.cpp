#include "content/make/person/person.h"

#include "content/bake/tangents.h"
#include "content/make/models/rigid_parts.h"
#include "content/make/models/simplify_mesh.h"
#include "content/make/person/person_bends.h"
#include "content/make/person/person_clips.h"
#include "content/make/person/person_cloth.h"
#include "content/make/person/person_face.h"
#include "content/make/person/person_growth.h"
#include "content/make/person/person_parts.h"
#include "ecs/components/dress.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr float kSmooth = kPi;
constexpr float kThinning = 0.0017f;      ///< what details of cloth may move [m]
constexpr float kSkinThinning = 0.0005f;  ///< likewise of arms
constexpr float kClothCrease = 1.25f;     ///< hems are sharp [rad]
constexpr float kTrimCrease = 0.9f;
constexpr float kShoeCrease = 0.9f;

MeshData finish_half(BodyMesh& half, const PersonFrame& frame, float crease, bool folds) {
    half.fair(4);
    half.mirror();
    half.face_outwards();
    if (folds) {
        fold_cloth(half, frame);
    }
    return half.finish(frame, crease);
}

/// A garment and what is sewn onto it, which keeps all its triangles.
MeshData finish_garment(BodyMesh& half, BodyMesh& trims, const PersonFrame& frame, float thinning) {
    MeshData mesh = finish_half(half, frame, kClothCrease, true);
    thin_out(mesh, frame, thinning, kClothCrease);
    if (!trims.vertices.empty()) {
        append_part(mesh, finish_half(trims, frame, kTrimCrease, true));
    }
    return mesh;
}

MeshData make_skin(const PersonFrame& frame) {
    MeshData mesh = make_person_head(frame);
    const PersonHems hems = person_hems(frame);
    BodyMesh arm;
    add_arm(arm, frame, hems.sleeve - 0.045f);
    MeshData arms = finish_half(arm, frame, kSmooth, false);
    thin_out(arms, frame, kSkinThinning, kSmooth);
    append_part(mesh, arms);
    if (frame.look.shape.legs != PersonLegwear::Trousers) {
        BodyMesh leg;
        add_leg(leg, frame, hems.leg + 0.06f);
        MeshData legs = finish_half(leg, frame, kSmooth, false);
        thin_out(legs, frame, kSkinThinning, kSmooth);
        append_part(mesh, legs);
    }
    return mesh;
}

DressedPart dressed_part(PersonPart part) {
    switch (part) {
    case PersonPart::Skin:
        return DressedPart::Skin;
    case PersonPart::Hair:
        return DressedPart::Hair;
    case PersonPart::Shirt:
        return DressedPart::Shirt;
    case PersonPart::Trousers:
        return DressedPart::Legs;
    default:
        return DressedPart::Other;
    }
}

MeshData make_person_part(const PersonFrame& frame, PersonPart part) {
    BodyMesh mesh;
    BodyMesh trims;
    MeshData whole;
    switch (part) {
    case PersonPart::All:
        break;
    case PersonPart::Skin:
        return make_skin(frame);
    case PersonPart::Eyes:
        add_eyes(mesh, frame);
        mesh.face_outwards();
        return mesh.finish(frame, kSmooth);
    case PersonPart::Hair:
        add_hair(mesh, frame);
        mesh.face_outwards();
        whole = mesh.finish(frame, kSmooth);
        if (!whole.indices.empty()) {
            thin_out(whole, frame, 0.95f * kThinning, kSmooth);
        }
        return whole;
    case PersonPart::Shirt:
        add_shirt(mesh, frame);
        add_shirt_trims(trims, frame);
        // What has no trims affords more triangles, what reaches to the knees fewer.
        return finish_garment(
            mesh, trims, frame,
            (trims.vertices.empty()                    ? 0.5f
             : frame.look.shape.top == PersonTop::Coat ? 1.05f
                                                       : 0.9f)
                * kThinning);
    case PersonPart::Trousers:
        add_trousers(mesh, frame);
        add_trouser_trims(trims, frame);
        return finish_garment(mesh, trims, frame, kThinning);
    case PersonPart::Shoes:
        add_shoe(mesh, frame);
        whole = finish_half(mesh, frame, kShoeCrease, false);
        thin_out(whole, frame, kThinning, kShoeCrease);
        return whole;
    }
    for (const PersonPart each :
         {PersonPart::Skin, PersonPart::Eyes, PersonPart::Hair, PersonPart::Shirt,
          PersonPart::Trousers, PersonPart::Shoes}) {
        MeshData mesh_of_part = make_person_part(frame, each);
        for (Vec4& color : mesh_of_part.colors) {
            color.w = alpha_of_part(dressed_part(each));
        }
        append_part(whole, mesh_of_part);
    }
    return whole;
}

}  // namespace

MeshData make_person(const PersonShape& shape) {
    const PersonFrame frame = measure_person(shape);
    MeshData mesh = make_person_part(frame, shape.part);
    mesh.name = "person";
    const PersonFrame own = grown_frame(frame);
    grow_mesh(mesh, frame, own);
    if (shape.triangles > 0) {
        simplify_mesh(mesh, static_cast<std::size_t>(shape.triangles));
    } else if (shape.part != PersonPart::Eyes && shape.part != PersonPart::Hair) {
        std::vector<MorphTarget> face = std::exchange(mesh.morphs, {});
        add_bend_shapes(mesh, make_person_skeleton(own));
        std::ranges::move(face, std::back_inserter(mesh.morphs));
    }
    update_bounds(mesh);
    return mesh;
}

MeshRig make_person_rig(const PersonShape& shape) {
    const PersonFrame frame = grown_frame(measure_person(shape));
    MeshRig rig;
    rig.skeleton = make_person_skeleton(frame);
    rig.skin = make_rigid_skin(rig.skeleton);
    rig.clips = make_person_clips(frame);
    const bool has_face = shape.part == PersonPart::All || shape.part == PersonPart::Skin;
    if (has_face && has_face_shapes(shape)) {
        // Levels of detail have no bend shapes before those of the face.
        const std::uint16_t first = shape.triangles > 0 ? 0 : kPersonBendShapes;
        std::ranges::move(make_person_face_clips(first), std::back_inserter(rig.clips));
    }
    return rig;
}

}  // namespace limn
