// Lights six points of each triangle.
#version 450
#define FACET_SAMPLES 6
#include "lib/facet_samples.glsl"
