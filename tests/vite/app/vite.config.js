import lamplight from "@lamplight/vite";

export default { plugins: [lamplight({ targets: ["essl300"] })], build: { target: "esnext" } };
