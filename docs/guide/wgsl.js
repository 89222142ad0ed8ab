// WGSL for the book's highlighter, which does not know it.
(function () {
    const comments = [
        { className: "comment", begin: "//", end: "$" },
        { className: "comment", begin: "/\\*", end: "\\*/" },
    ];
    hljs.registerLanguage("wgsl", () => ({
        keywords: {
            keyword:
                "alias break case const const_assert continue continuing default diagnostic discard else enable " +
                "fn for if import as let loop override return struct super package switch var while",
            literal: "true false",
            type: "bool f16 f32 i32 u32 vec2f vec3f vec4f vec2i vec3i vec4i vec2u vec3u vec4u mat3x3f mat4x4f array",
        },
        contains: [
            ...comments,
            { className: "meta", begin: "@[a-z]+" },
            { className: "number", begin: "\\b[0-9][0-9a-fA-FxX.eu]*" },
        ],
    }));
    for (const block of document.querySelectorAll("code.language-wgsl")) {
        hljs.highlightBlock(block);
    }
})();
