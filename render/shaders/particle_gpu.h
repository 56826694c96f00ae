// Particles on the GPU (render/passes/particle_pass.h). Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// A particle: texels of four words.
//   0  position xyz [m] as floats; share of the life (16 bits) below the index of its look
//   1  velocity [m/s] and age [s] as four halfs; random bits; 0
const uint kParticleTexels = 2u;

// A segment of a ribbon, in place of a particle: its look is one of facing kFacingRibbon.
//   0  its middle; index of its look in the upper 16 bits
//   1  index of the point before it
// Points of ribbons (RibbonList): texels of four floats.
//   0  position xyz [m]; texture coordinate along the ribbon
//   1  from edge to edge xyz [m], 0: faces the camera; share of the curves
const uint kRibbonTexels = 2u;
const uint kFacingRibbon = 3u;  // after those of ParticleFacing

// A look: texels of four floats.
//   0  diameter [m], give or take; angle [rad], give or take; spin [rad/s]
//   1  spin, give or take; stretch [s]; softness [m]; forward
//   2  emission; lit; cover; facing
//   3  columns, rows; frames per second; layer of the image, -1: a soft disc
//   4  factors on the size, four samples a texel
//  12  color and opacity, a sample a texel
const uint kLookSamples = 32u;  // evenly over the life, the first at its beginning and the last at its end
const uint kLookSizes = 4u;
const uint kLookColors = 12u;
const uint kLookTexels = 44u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
