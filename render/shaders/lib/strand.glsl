// Light on thin strands along a unit tangent t, which reflect by the normal that lies in the plane of light and strand
// (Banks, "Illumination in Diverse Codimensions", 1994). u = l.t, v = v.t; t and -t are the same strand.
// Techniques: shade.strand-banks

// l.n of the strand's normal that is nearest to the light.
float strand_diffuse(float u) {
    return sqrt(max(1.0 - u * u, 0.0));
}

// r.v for the nearest of the directions that the strand mirrors the light to, a cone about it.
float strand_mirrored(float u, float v) {
    return max(strand_diffuse(u) * strand_diffuse(v) - u * v, 0.0);
}
