// portable.h -- exponential, sine and cosine from + - * / alone: the same bits on every machine.
#pragma once

// e^x to 12 digits; 0 below -700.
double gen_exp(double x);

// Sine and cosine of any angle up to some hundred turns, radians.
double gen_sin(double x);
double gen_cos(double x);

#define GEN_PI 3.14159265358979323846
