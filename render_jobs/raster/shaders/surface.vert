#version 330 core
// A vertex now and at the next frame, in the axes of the camera of its frame (x right, y down, z forward).
layout(location = 0) in vec3 position_now;
layout(location = 1) in vec3 position_next;
layout(location = 2) in vec3 normal;
layout(location = 3) in vec2 uv;

uniform mat4 placement;
uniform mat4 world_to_camera_now;
uniform mat4 world_to_camera_next;
uniform mat4 projection;
uniform mat4 world_to_shadow;

// centroid: at the rim of a triangle, antialiasing must not read values from beyond it
centroid out vec3 world;
centroid out vec3 world_normal;
centroid out vec3 in_shadow_map;
centroid out vec2 texture_at;
out vec3 camera_now;
out vec3 camera_next;

void main() {
    vec4 here = placement * vec4(position_now, 1.0);
    vec4 there = placement * vec4(position_next, 1.0);
    world = here.xyz;
    camera_now = (world_to_camera_now * here).xyz;
    camera_next = (world_to_camera_next * there).xyz;
    world_normal = transpose(inverse(mat3(placement))) * normal;
    in_shadow_map = (world_to_shadow * here).xyz * 0.5 + 0.5;
    texture_at = uv;
    gl_Position = projection * vec4(camera_now, 1.0);
}
