// Inverse Fourier transform of lines of SIZE complex numbers, four lines at once, by the SIZE / 4 invocations of a
// work group: Stockham, radix 4, with a last radix-2 step where SIZE is not a power of four. The same as
// systems/water/fft_kernels.h.
//
//     line(x) = sum over n of line(n) e^(2 pi i n x / SIZE)
// Techniques: water.fft-synthesis

const uint kLineGroup = SIZE / 4u;
const float kFullTurn = 6.28318530718;

layout(local_size_x = SIZE / 4) in;

// Element n, two complex numbers each. Write all of them, call transform_line(), read all of them.
shared vec4 line_ab[SIZE];
shared vec4 line_cd[SIZE];

struct Quad {
    vec4 ab;
    vec4 cd;
};

Quad load_line(uint i) {
    return Quad(line_ab[i], line_cd[i]);
}
void store_line(uint i, Quad z) {
    line_ab[i] = z.ab;
    line_cd[i] = z.cd;
}
Quad plus(Quad a, Quad b) {
    return Quad(a.ab + b.ab, a.cd + b.cd);
}
Quad minus(Quad a, Quad b) {
    return Quad(a.ab - b.ab, a.cd - b.cd);
}
vec4 times_pair(vec4 z, vec2 root) {
    return vec4(
        z.x * root.x - z.y * root.y, z.x * root.y + z.y * root.x, z.z * root.x - z.w * root.y,
        z.z * root.y + z.w * root.x);
}
Quad times(Quad z, vec2 root) {
    return Quad(times_pair(z.ab, root), times_pair(z.cd, root));
}
Quad times_i(Quad z) {  // i z
    return Quad(vec4(-z.ab.y, z.ab.x, -z.ab.w, z.ab.z), vec4(-z.cd.y, z.cd.x, -z.cd.w, z.cd.z));
}

void transform_line() {
    const uint i = gl_LocalInvocationID.x;
    uint stride = 1u;
    for (uint length = SIZE; length >= 4u; length /= 4u) {
        uint p = i / stride;
        float angle = kFullTurn * float(p) / float(length);
        vec2 root1 = vec2(cos(angle), sin(angle));
        vec2 root2 = vec2(root1.x * root1.x - root1.y * root1.y, 2.0 * root1.x * root1.y);
        vec2 root3 = vec2(root2.x * root1.x - root2.y * root1.y, root2.x * root1.y + root2.y * root1.x);
        barrier();
        Quad x0 = load_line(i);
        Quad x1 = load_line(i + kLineGroup);
        Quad x2 = load_line(i + 2u * kLineGroup);
        Quad x3 = load_line(i + 3u * kLineGroup);
        Quad even = plus(x0, x2);
        Quad odd = plus(x1, x3);
        Quad even_rest = minus(x0, x2);
        Quad odd_rest = times_i(minus(x1, x3));
        uint to = i + 3u * stride * p;  // i = p * stride + the sequence's number
        barrier();
        store_line(to, plus(even, odd));
        store_line(to + stride, times(plus(even_rest, odd_rest), root1));
        store_line(to + 2u * stride, times(minus(even, odd), root2));
        store_line(to + 3u * stride, times(minus(even_rest, odd_rest), root3));
        stride *= 4u;
    }
    barrier();
    if (stride < SIZE) {
        for (uint j = i; j < SIZE / 2u; j += kLineGroup) {
            Quad x0 = load_line(j);
            Quad x1 = load_line(j + SIZE / 2u);
            store_line(j, plus(x0, x1));
            store_line(j + SIZE / 2u, minus(x0, x1));
        }
        barrier();
    }
}
