// Light within a fold: a long groove between two walls whose slopes face each other (wrinkle.fold-light). `open` is the
// cosine of the slope, the sine of half the angle between the walls: the fraction of a wall's diffuse light that leaves
// the groove, and of ambient light that reaches a wall; the rest falls on the other wall. All walls are assumed to be
// evenly lit, by exact means; folds are assumed to be V-shaped, with the slope of the shaded point.
// Oren and Nayar, "Generalization of Lambert's Reflectance Model", 1994; infinite bounces as in Jimenez et al.,
// "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016.
// Techniques: wrinkle.fold-light

// Mean cosines of a light at a wall and at the opposite one. All light through the mouth of the groove falls on the two
// walls: a wall that receives less than its cosine is partly shadowed by the other. `n_l`: of the wall, `m_l`: of the
// mouth, the skin without folds.
vec2 wall_cosines(float open, float n_l, float m_l) {
    float both = max(2.0 * open * m_l, 0.0);
    float own = clamp(n_l, 0.0, both);
    return vec2(own, both - own);
}

// Diffuse light of a wall of this albedo from the light that reaches it, `own`, and the other wall, with all bounces.
vec3 wall_light(float open, vec3 albedo, vec3 own, float other) {
    vec3 bounced = albedo * (1.0 - open);
    return (own + bounced * other) / (1.0 - bounced * bounced);
}

// The same for ambient light of 1 on skin without folds.
vec3 wall_light_around(float open, vec3 albedo) {
    return open / (1.0 - albedo * (1.0 - open));
}
