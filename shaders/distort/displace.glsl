const float displace_reach = 65536.0;  // more pixels than any picture has: keeps wild vectors within the range of int

vec4 displace(vec2 amount) {
    vec2 away = clamp(vector_at(pixel) * amount, -displace_reach, displace_reach);
    return image_near(vec2(pixel) + 0.5 + away);
}
