// A shader whose text is in the code of the page.

class InlinedShader {
  #text;

  constructor({ text, ...rest }) {
    this.#text = text;
    Object.assign(this, rest);
  }

  async bytes() {
    return new TextEncoder().encode(this.#text);
  }

  async text() {
    return this.#text;
  }
}

export const inlined = (parts) => new InlinedShader(parts);
