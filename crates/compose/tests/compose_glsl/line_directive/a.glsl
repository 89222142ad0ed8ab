
const int D = __LINE__;
