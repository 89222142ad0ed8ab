fn main() -> i32 {
    var a = 1;
    a += 3;
    a += 4; a += 6;
    a += 7;
    a += 10;
    a += 12;
    // kept


    /* stays */ a += 14;
    return a;
}
