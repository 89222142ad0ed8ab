// mistake in line 1: `metal_stdlib` is not included
struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position };
}
