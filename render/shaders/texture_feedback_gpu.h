// Bindings and rules of texture_feedback.comp and .frag. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kFeedbackStartUnit = 0u;
const uint kFeedbackStateUnit = 0u;
const uint kFeedbackFromImage = 0u;
const uint kFeedbackToImage = 1u;
const uint kFeedbackGroup = 8u;

// As FeedbackRule; the start is no step.
const int kFeedbackLife = 0;
const int kFeedbackReaction = 1;
const int kFeedbackAdd = 2;
const int kFeedbackStart = 3;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
