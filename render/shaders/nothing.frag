// Colors nothing: for passes that only count in depth or stencil.
#version 450

void main() {}
