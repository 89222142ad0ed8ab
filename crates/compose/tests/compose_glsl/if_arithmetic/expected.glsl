#version 450

const int ok_1 = 1;

const int ok_2 = 2;

const int ok_3 = 3;

const int ok_4 = 4;

const int ok_5 = 5;

const int ok_6 = 6;

const int ok_7 = 7;

const int ok_8 = 8;

const int ok_9 = 9;

const int ok_10 = 10;

const int ok_11 = 11;

const int ok_12 = 12;

void main() {
    int sum = ok_1 + ok_2 + ok_3 + ok_4 + ok_5 + ok_6 + ok_7 + ok_8 + ok_9 + ok_10 + ok_11 + ok_12;
}
// ---- Fragment; reads: 
