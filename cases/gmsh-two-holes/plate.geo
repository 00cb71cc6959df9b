// Plate with two holes; gmsh -2 plate.geo -format msh41
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 20, 10};
Disk(2) = {6, 5, 0, 1.5};
Disk(3) = {14, 5, 0, 1.5};
BooleanDifference(4) = { Surface{1}; Delete; }{ Surface{2, 3}; Delete; };

e = 1e-3;
Physical Curve("left") = Curve In BoundingBox{-e, -e, -e, e, 10 + e, e};
Physical Curve("right") = Curve In BoundingBox{20 - e, -e, -e, 20 + e, 10 + e, e};
Physical Curve("bottom") = Curve In BoundingBox{-e, -e, -e, 20 + e, e, e};
Physical Curve("top") = Curve In BoundingBox{-e, 10 - e, -e, 20 + e, 10 + e, e};
Physical Curve("hole-1") = Curve In BoundingBox{4, 3, -e, 8, 7, e};
Physical Curve("hole-2") = Curve In BoundingBox{12, 3, -e, 16, 7, e};
Physical Surface("plate") = {4};

Mesh.MeshSizeMax = 2.5;
Mesh.MeshSizeFromCurvature = 48; // edges per circle
