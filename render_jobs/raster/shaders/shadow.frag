#version 330 core
// Depth alone; what is cut away casts no shadow.
centroid in vec2 texture_at;

uniform bool has_texture;
uniform bool uses_alpha;
uniform sampler2D base_texture;

void main() {
    if (has_texture && uses_alpha && texture(base_texture, texture_at).a < 0.5) discard;
}
