// IM6/934, 32 plies (AFWAL-TR-87-4117, Table 6, first row).
// A rectangular plate, 127 mm along x by 76.2 mm, simply supported along its edge, without overhang; lengths in mm.
// plate.msh was made by gmsh 4.15.2 with
//   gmsh plate.geo -2 -o plate.msh
// Cells half as long everywhere: gmsh plate.geo -setnumber h 1.27 -2 -o plate.msh
//
// Square cells up to c from the impact point in x and y, growing from there to the sides. Sixteen blocks, so that the
// impact point is a node.

DefineConstant[ h = 2.54 ];         // length of the cells at the centre
X = 63.5;                           // half the length
Y = 38.1;                           // half the width
c = 7.62;                           // half the width of the square of equal cells
growth = 1.15^(h/2.54);             // length of a cell outside it over that of its inner neighbour

equal = Round(c/h);
x[] = {-X, -c, 0, c, X};
y[] = {-Y, -c, 0, c, Y};
across = Round(Log(1 + (Y - c)*(growth - 1)/(growth*h))/Log(growth));
along = Round(Log(1 + (X - c)*(growth - 1)/(growth*h))/Log(growth));
cells[] = {along, equal, equal, along, across, equal, equal, across};
bias[] = {1/growth, 1, 1, growth};

For j In {0:4}
  For i In {0:4}
    Point(10*j + i) = {x[i], y[j], 0};
  EndFor
EndFor
For j In {0:4}
  For i In {0:3}
    Line(100 + 10*j + i) = {10*j + i, 10*j + i + 1};
    Transfinite Curve{100 + 10*j + i} = cells[i] + 1 Using Progression bias[i];
    Line(200 + 10*j + i) = {10*i + j, 10*(i + 1) + j};
    Transfinite Curve{200 + 10*j + i} = cells[4 + i] + 1 Using Progression bias[i];
  EndFor
EndFor
For j In {0:3}
  For i In {0:3}
    Curve Loop(1 + 4*j + i) = {100 + 10*j + i, 200 + 10*(i + 1) + j, -(110 + 10*j + i), -(200 + 10*i + j)};
    Plane Surface(1 + 4*j + i) = {1 + 4*j + i};
  EndFor
EndFor
Transfinite Surface{1:16};
Recombine Surface{1:16};

Physical Surface("plate") = {1:16};
Physical Curve("support") = {100:103, 140:143, 200:203, 240:243};
Physical Point("impact") = {22};
Mesh.MshFileVersion = 4.1;
