// Lights ten points of each triangle.
#version 450
#define FACET_SAMPLES 10
#include "lib/facet_samples.glsl"
