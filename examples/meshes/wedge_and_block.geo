// A blunt wedge (the hammer) above a block with a round hole (the anvil). Lengths in m.
// gmsh -2 -format msh41 wedge_and_block.geo
SetFactory("Built-in");
Mesh.ElementOrder = 1;
Mesh.MeshSizeFromPoints = 1;
fine = 0.0016;
coarse = 0.007;

// Hammer: half-width 30 mm, flanks at 45 degrees down to a nose of 12 mm radius that is 0.5 mm above the anvil.
x = 0.012;            // the hammer is off the centre of the anvil
y = 0.0005;
r = 0.012;
k = r * Sqrt(2) / 2;  // the nose meets the flanks at 45 degrees
Point(1) = {x, y + r, 0, fine};                                // centre of the nose
Point(2) = {x, y, 0, fine};
Point(3) = {x + k, y + r - k, 0, fine};
Point(4) = {x + 0.030, y + r - k + 0.030 - k, 0, coarse};
Point(5) = {x + 0.030, y + 0.070, 0, coarse};
Point(6) = {x - 0.030, y + 0.070, 0, coarse};
Point(7) = {x - 0.030, y + r - k + 0.030 - k, 0, coarse};
Point(8) = {x - k, y + r - k, 0, fine};
Circle(1) = {2, 1, 3};
Line(2) = {3, 4};
Line(3) = {4, 5};
Line(4) = {5, 6};
Line(5) = {6, 7};
Line(6) = {7, 8};
Circle(7) = {8, 1, 2};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7};
Plane Surface(1) = {1};

// Anvil: 140 mm by 55 mm, top at y = 0, a hole of 12 mm radius under its middle.
Point(11) = {-0.070, -0.055, 0, coarse};
Point(12) = {0.070, -0.055, 0, coarse};
Point(13) = {0.070, 0, 0, coarse};
Point(14) = {x + 0.020, 0, 0, fine};
Point(15) = {x - 0.020, 0, 0, fine};
Point(16) = {-0.070, 0, 0, coarse};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 15};
Line(15) = {15, 16};
Line(16) = {16, 11};
Curve Loop(11) = {11, 12, 13, 14, 15, 16};
Point(21) = {0, -0.030, 0, coarse / 2};
Point(22) = {0.012, -0.030, 0, coarse / 2};
Point(23) = {0, -0.018, 0, coarse / 2};
Point(24) = {-0.012, -0.030, 0, coarse / 2};
Point(25) = {0, -0.042, 0, coarse / 2};
Circle(21) = {22, 21, 23};
Circle(22) = {23, 21, 24};
Circle(23) = {24, 21, 25};
Circle(24) = {25, 21, 22};
Curve Loop(12) = {21, 22, 23, 24};
Plane Surface(2) = {11, 12};

Physical Surface("hammer") = {1};
Physical Surface("anvil") = {2};
Physical Curve("nose") = {1, 7};
Physical Curve("back") = {4};
Physical Curve("face") = {13, 14, 15};
Physical Curve("base") = {11};
Physical Curve("hole") = {21, 22, 23, 24};
