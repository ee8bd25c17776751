// AS4/3502, diameter 75 mm, 16 plies (case 2 of AFWAL-TR-87-4117, Table 1).
// A circular plate on a simple support along its edge, without overhang; lengths in mm.
// plate.msh was made by gmsh 4.15.2 with
//   gmsh plate.geo -2 -o plate.msh
// Cells half as long everywhere: gmsh plate.geo -setnumber h 1.27 -2 -o plate.msh
//
// An O-grid: a square core with bulged sides, in quarters so that the impact point is a node, and eight blocks
// around it out to the circle. The nodes of the boundary lie on the circle; its 48 straight edges enclose 0.29 % less.

DefineConstant[ h = 2.54 ];         // length of the cells at the centre
R = 37.5;                           // radius of the support
n = Round(15.24 / h);               // cells from the centre to a side of the core
w = n*h;                            // half the width of the core
shrink = 1;                         // length of a cell of the core over that of its inner neighbour
rings = Round(5 * 2.54 / h);        // cells from the core to the circle
growth = 1.15^(h/2.54);             // length of a cell there over that of its inner neighbour
s = 0.88 * w;                       // corners of the core at (s, s): inner angles up to 121 degrees
e = (2*s^2 - w^2) / (2*(w - s));    // its sides are arcs about points this far behind the centre

Point(1) = {0, 0, 0};
For i In {0:7}
  r = (i % 2) ? s*Sqrt(2) : w;
  Point(10 + i) = {r*Cos(i*Pi/4), r*Sin(i*Pi/4), 0};
  Point(20 + i) = {R*Cos(i*Pi/4), R*Sin(i*Pi/4), 0};
EndFor
For k In {0:3}
  Point(30 + k) = {-e*Cos(k*Pi/2), -e*Sin(k*Pi/2), 0};
  Line(100 + k) = {1, 10 + 2*k};
  Transfinite Curve{100 + k} = n + 1 Using Progression shrink;
EndFor
For i In {0:7}
  j = (i + 1) % 8;
  Circle(110 + i) = {10 + i, 30 + Floor(j/2), 10 + j};
  Line(120 + i) = {10 + i, 20 + i};
  Circle(130 + i) = {20 + i, 1, 20 + j};
  Transfinite Curve{110 + i} = n + 1 Using Progression ((i % 2) ? 1/shrink : shrink);
  Transfinite Curve{120 + i} = rings + 1 Using Progression growth;
  Transfinite Curve{130 + i} = n + 1;
EndFor
For k In {0:3}
  Curve Loop(1 + k) = {100 + k, 110 + 2*k, 111 + 2*k, -(100 + (k + 1) % 4)};
EndFor
For i In {0:7}
  Curve Loop(5 + i) = {120 + i, 130 + i, -(120 + (i + 1) % 8), -(110 + i)};
EndFor
For i In {1:12}
  Plane Surface(i) = {i};
EndFor
Transfinite Surface{1:12};
Recombine Surface{1:12};

Physical Surface("plate") = {1:12};
Physical Curve("support") = {130:137};
Physical Point("impact") = {1};
Mesh.MshFileVersion = 4.1;
