// The scene of `scene.h`, for the clients in JavaScript.

export const WIDTH = 48;
export const HEIGHT = 40;

/** Positions and coordinates of textures. */
export const VERTICES = Float32Array.of(
  -0.9, -0.7, 0.1, 0.0, 1.0, 0.8, -0.8, 0.0, 1.0, 1.0, 0.7, 0.9, 0.2, 1.0, 0.0,
  -0.9, -0.7, 0.1, 0.0, 1.0, 0.7, 0.9, 0.2, 1.0, 0.0, -0.5, 0.4, 0.0, 0.0, 0.0,
);

/** Four columns and three rows. */
export const IMAGE = Uint8Array.of(
  255, 40, 30, 255, 40, 200, 60, 255, 50, 60, 220, 255, 240, 230, 40, 255,
  20, 180, 170, 255, 200, 60, 190, 255, 90, 90, 90, 255, 255, 255, 255, 255,
  130, 70, 20, 255, 250, 150, 40, 255, 30, 30, 100, 255, 10, 90, 20, 255,
);

/** Whether each texel of the shadow map is nearer than the surface. */
export const NEAR = Array.from({ length: 64 }, (_, i) => 2 * (i >> 3) > (i & 7) + 5);

/** Matrices are lists of columns. */
export const CAMERA = {
  clip_from_world: [0.9, 0.1, 0, 0, -0.15, 0.8, 0, 0, 0, 0, 0.5, 0.3, 0.05, -0.1, 0.25, 1],
  normal_from_object: [1, 0.3, 0, 0, 0.9, -0.4, -0.2, 0, 1.1],
  eye: [0.4, 0.3, 2],
  exposure: 0.8,
};

export const LAMPS = {
  all: [
    { position: [0.6, 0.5, 1.2], strength: 1, color: [1, 0.8, 0.5] },
    { position: [-0.7, 0.2, 0.9], strength: 1.7, color: [0.4, 0.6, 1] },
    { position: [0, 0, 0.3], strength: 2.4, color: [9, 0, 9] },
  ],
  axis: [0.3, 0.2, 0.93],
  count: 2,
};

export const KEYS = ["point", "spot"].flatMap((lamp) =>
  ["none", "hard", "pcf"].flatMap((shadow) =>
    [8, 32, 128].map((gloss) => `lamp=${lamp},shadow=${shadow},gloss=${gloss}`),
  ),
);
