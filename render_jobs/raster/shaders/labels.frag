#version 330 core
// What the pixel centre sees: track id and planar depth, normal in the camera's axes, motion in pixels.
in vec3 camera_now;
in vec3 camera_next;
centroid in vec3 world_normal;
centroid in vec2 texture_at;

uniform mat4 world_to_camera_now;
uniform mat3 intrinsics_next;
uniform float track_id;
uniform bool smooth_shading;
uniform bool one_sided;
uniform bool has_texture;
uniform bool uses_alpha;
uniform sampler2D base_texture;

layout(location = 0) out vec4 surface;
layout(location = 1) out vec4 facing;
layout(location = 2) out vec4 motion;

void main() {
    if (one_sided && !gl_FrontFacing) discard;
    if (has_texture && uses_alpha && texture(base_texture, texture_at).a < 0.5) discard;
    vec3 across = cross(dFdx(camera_now), dFdy(camera_now));
    vec3 n = smooth_shading ? mat3(world_to_camera_now) * world_normal : across;
    n = normalize(n);
    vec3 seen = intrinsics_next * camera_next;
    surface = vec4(track_id, camera_now.z, 0.0, 1.0);
    bool towards_us = smooth_shading ? gl_FrontFacing : dot(n, camera_now) < 0.0;
    facing = vec4(towards_us ? n : -n, 1.0);
    motion = vec4(seen.xy / seen.z - gl_FragCoord.xy, 0.0, 1.0);
}
