// Particles on the GPU (render/particles/particle_pass.h). Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// A particle: words.
//   0  position xyz [m] as floats
//   3  fraction of the life (16 bits) below the index of its look
//   4  velocity [m/s] and age [s] as four halfs; a negative age: dead
//   6  random bits
const uint kParticleWords = 7u;
const uint kDeadAge = 0xbc000000u;  // word 5 of one that is not there

// A segment of a ribbon, instead of a particle: its look is one of facing kFacingRibbon.
//   0  its center
//   4  index of the point before it
// Points of ribbons (RibbonList): texels of four floats.
//   0  position xyz [m]; texture coordinate along the ribbon
//   1  from edge to edge xyz [m], 0: faces the camera; position on the curves
const uint kRibbonTexels = 2u;
const uint kFacingRibbon = 5u;  // after those of ParticleFacing

// A billboard, instead of a particle: its look is one of facing kFacingBillboard, its fraction of the life is that of its
// colors.
//   4  index of its quad; its opacity as a float
// Quads of billboards (BillboardList): texels of four floats.
//   0  half the extent to the right xyz [m]; BillboardAlignment
//   1  half the extent upward xyz [m]; frame of the flipbook
//   2  velocity xyz [m/s]
const uint kBillboardTexels = 3u;
const uint kFacingBillboard = 6u;

// A look: texels of four floats.
//   0  diameter [m], give or take; angle [rad], give or take; spin [rad/s]
//   1  spin, give or take; stretch [s]; softness [m]; forward
//   2  emission; lit; cover; facing
//   3  columns, rows; frames per second; layer of the image, -1: a soft disc
//   4  factors on the size, four samples a texel
//  12  color and opacity, a sample a texel
//  44  frames of the flipbook; near and far fade [m]; tumble [rad/s]
const uint kLookSamples = 32u;  // evenly over the life, the first at its beginning and the last at its end
const uint kLookSizes = 4u;
const uint kLookColors = 12u;
//  45  a, b, c of the attenuation of point sprites; fade [s]
//  46  position in the colors by age: wave, base, amplitude, phase
//  47  its frequency [Hz]; give or take of the color
const uint kLookMore = 44u;
//  48  factors on the optical depth of its shadow for red, green and blue; factor on the opacity, 0: casts none
const uint kLookShadow = 48u;
//  49  layer of the motion map, -1: none; what its full value means, as a fraction of a frame; coverage above which pixels
//      move with it, 1: never; layer of the image of light from negative sides, -1: none
const uint kLookMotion = 49u;
//  50  acceleration at rest [m/s^2]; drag [1/s]
//  51  opacity above which the lens focuses on them, 1: never; 1: lit at the center, by particle_light.comp
const uint kLookFocus = 51u;
//  52  insets of the frames of its image (render/particles/frame_insets.h), four frames a texel: left, bottom, right and top as
//      digits to the base kInsetSteps / 2, the first one counting 1
const uint kLookInsets = 52u;
const uint kMaxInsetFrames = 64u;
const uint kInsetSteps = 128u;  // of a frame
const uint kLookTexels = kLookInsets + kMaxInsetFrames / 4u;

// ParticleShadowRecord: rows that map the world to the opacity maps (lib/particle_shadow.glsl).
//   0, 1, 3  texture coordinates s and t, as rows 0 and 1 divided by row 3
//   2        depth, as a fraction of the range of depths that casters are in; not divided
//   4        index of the light that they shadow, -1: none; fractions of the range of depths per meter; that index, whether or
//            not anything casts
const uint kParticleShadowTexels = 5u;

// Particles that the GPU moves (render/particles/gpu_particle_pools.h): texels of four floats, words as bits.
//   0  seed of the random numbers: key (2 words); subject (2 words)
//   1  high word of the number of the oldest particle; shape, direction (words); cosine of the cone
//   2  size of the shape; speed
//   3  speed, give or take; lifetime, give or take; 0
//   4  position, give or take; 0
//   5  velocity, give or take; 0
//   6  of collisions: bounce, friction, radius, action (word; 0: none)
// then the steps, kStepTexels each, then the runs of births: instant of the first, spacing (fractions of the step), number;
// then the forces of fields: origin, kind (word); axis, strength times dt; speed, radius;
// then the colliders, see particle_collide.glsl; then the places of births: position, age; velocity, kind (word); turn.
const uint kEmitterTexels = 7u;
//   0  number of its first birth (low word), births, first run, runs (words)
//   1  acceleration times dt; dt
//   2  velocity of the air; fraction of the velocity that is kept
//   3  rows of the emitter's matrix at the beginning, 6 at the end
//   9  velocity that is added at birth; fraction of the step in which the old velocity counts
//  10  drift a of the turbulence; its strength times dt
//  11  drift b; 1 / size
//  12  origin of axis; acceleration around it times dt
//  13  axis; acceleration toward it times dt
//  14  orbit; loss of speed; seed of the turbulence (word); 0
//  15  center of the box that particles stay in; first texel of the forces of fields (word)
//  16  its extents; number of forces (word)
//  17  first texel of the colliders, number of them; first texel of the places, index of the first birth that has one (words)
const uint kStepTexels = 18u;
const uint kColliderTexels = 5u;
const uint kForceTexels = 3u;
const uint kPlaceTexels = 3u;
const uint kParticleGroup = 128u;  // particles of a work group

// Bindings: of what draws particles,
const uint kSpriteImagesUnit = 0u;
const uint kSpriteMotionsUnit = 1u;
const uint kParticlesUnit = 2u;
const uint kLooksUnit = 3u;
const uint kParticleDepthUnit = 4u;  // of the scene
const uint kRibbonPointsUnit = 8u;
const uint kParticleVeilUnit = 23u;
const uint kBillboardQuadsUnit = 26u;
const uint kNegativeLightsUnit = 27u;
const uint kCenterLightUnit = 28u;
const uint kCenterLightBinding = 0u;
const uint kSplatSumsBinding = 0u;
const uint kParticleLayerUnit = 0u;
const uint kParticleLayerDepthUnit = 1u;
const uint kWeightedSumUnit = 0u;
const uint kWeightedKeptUnit = 1u;
// of their shadows,
const uint kParticleOpacityUnit = 30u;
const uint kParticleShadowUnit = 31u;
const uint kShadowRangesBinding = 0u;
const uint kShadowRecordBinding = 1u;
// of what moves them,
const uint kParticleStepsUnit = 0u;
const uint kPreviousDepthUnit = 1u;
const uint kParticleShapesUnit = 2u;
const uint kParticleStateBinding = 0u;
const uint kParticleBitsBinding = 1u;
const uint kParticleInstancesBinding = 2u;
const uint kBallNearBinding = 1u;
const uint kBallEntriesBinding = 3u;
const uint kBallReadBinding = 4u;
const uint kBallWriteBinding = 5u;
const uint kBallNearWords = 32u;  // of each ball
// and of what sorts them.
const uint kSortEntriesBinding = 0u;
const uint kSortInstancesBinding = 1u;
const uint kSortedInstancesBinding = 2u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
