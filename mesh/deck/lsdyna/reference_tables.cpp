#include "mesh/deck/lsdyna/reference_tables.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr RuleKind kCards = RuleKind::cards;
constexpr FieldWidths kEightWide = FieldWidths::eights;
constexpr std::string_view kMotion = "n . . . . . .;?1.2=9,10,11,12,-9,-10,-11,-12 . . p n n";
constexpr std::string_view kMotionOptions = "ID^ TITLE^ LOCAL";
constexpr std::string_view kJoint = "n6";
constexpr std::string_view kJointOptions = "ID^ TITLE^ LOCAL+ FAILURE++";
constexpr std::string_view kJointWithParameters = "n6;";
constexpr std::string_view kInterpolatedBeam = "p p N";
constexpr std::string_view kWallOptions = "ORTHO++ FINITE+ MOVING+ FORCES+.,G,n4 ID^ TITLE^ DISPLAY";
constexpr std::string_view kCoupling = "@3:0P1p2G @4:0P1p2G";

/// The longest entry that a keyword begins with, by whole words, counts. Taken from the pages of the manual.
constexpr ReferenceRule kRules[] = {
    // mesh_cards.h reads nodes and elements themselves; these rules cover what else their cards name.
    {"NODE"},
    {"NODE_MERGE_SET", kCards, "N"},
    {"NODE_MERGE_TOLERANCE"},
    {"NODE_TRANSFORM", kCards, ". N"},
    {"ELEMENT_SHELL", RuleKind::nothing, "", "THICKNESS BETA MCID OFFSET DOF COMPOSITE LONG SHL4 TO SHL8"},
    {"ELEMENT_SOLID", RuleKind::nothing, "", "ORTHO DOF TET4TOTET10 H8TOH20 H8TOH27 H8TOH64 H20 H27 H64 P21 P40 T10 T15 T20 T35 FORMAT2"},
    {"ELEMENT_TSHELL", RuleKind::nothing, "", "BETA COMPOSITE"},
    {"ELEMENT_DISCRETE", RuleKind::nothing, "", "LCO"},
    {"ELEMENT_MASS"},
    {"ELEMENT_MASS_NODE_SET", kCards, ". N", "", false, false, kEightWide},
    {"ELEMENT_MASS_PART", kCards, "p", "", false, false, kEightWide},
    {"ELEMENT_MASS_PART_SET", kCards, "P", "", false, false, kEightWide},
    {"ELEMENT_SPH", RuleKind::nothing, "", "VOLUME"},
    {"ELEMENT_PLOTEL"},
    {"ELEMENT_BEAM", kCards, ".4 n", "THICKNESS+ SCALAR+ SCALR+ SECTION+ PID+p,p OFFSET+ ORIENTATION+ WARPAGE+n,n ELBOW+n", false, false,
     kEightWide},
    {"ELEMENT_SEATBELT", kCards, ".6 n n", "", false, false, kEightWide},
    {"ELEMENT_SEATBELT_ACCELEROMETER", kCards, ". n3"},
    {"ELEMENT_SEATBELT_RETRACTOR", kCards, ". n-N o;"},
    {"ELEMENT_SEATBELT_SENSOR", kCards, ";@1.2:1n2z3z4n5z @1.2:1z2z3z4n5z"},
    {"ELEMENT_SEATBELT_SLIPRING", kCards, ". o o . n-N . . n", "", true, true},
    {"ELEMENT_SEATBELT_PRETENSIONER", kCards, ";@1.2:1z2d3d4z5z6z7z8z9d"},
    {"ELEMENT_INERTIA", kCards, ". n;", "OFFSET+", false, false, kEightWide},
    {"ELEMENT_TRIM", kCards, "P"},

    {"PART", kCards, "^!", "CONTACT+ PRINT+ REPOSITION+ ATTACHMENT_NODES+N FIELD+ TITLE"},
    {"PART_INERTIA", kCards, "^!;.5 n;;;?2.5=1", "CONTACT+ PRINT+ REPOSITION+ ATTACHMENT_NODES+N FIELD+ TITLE"},
    {"PART_COMPOSITE", RuleKind::nothing, "", "*"},
    {"PART_MOVE", kCards, "@6:0p1P", "", false, false, FieldWidths::moves},
    {"PART_MOVE_SET", kCards, "P"},
    {"PART_ANNEAL", kCards, "p"},
    {"PART_ANNEAL_SET", kCards, "P"},
    {"PART_SENSOR", kCards, "p"},
    {"PART_ADAPTIVE_FAILURE", kCards, "p"},

    {"SET_NODE", RuleKind::set, "n", "*"},
    {"SET_PART", RuleKind::set, "p", "*"},
    {"SET_SHELL", RuleKind::set, "s", "*"},
    {"SET_BEAM", RuleKind::set, "b", "*"},
    {"SET_SOLID", RuleKind::set, "h", "*"},
    {"SET_TSHELL", RuleKind::set, "t", "*"},
    {"SET_DISCRETE", RuleKind::set, "d", "*"},
    {"SET_SEGMENT", RuleKind::set, "g", "*"},
    {"SET_2D_SEGMENT", kCards, "#;P N", "SET TITLE^", true},
    {"SET_MODE", RuleKind::nothing, "", "*"},
    {"SET_BOX", RuleKind::nothing, "", "*"},
    {"SET_MULTI_MATERIAL_GROUP_LIST", RuleKind::nothing, "", "TITLE"},

    {"BOUNDARY_SPC_NODE", kCards, "n", "ID^ BIRTH_DEATH+"},
    {"BOUNDARY_SPC_SET", kCards, "N", "ID^ BIRTH_DEATH+"},
    {"BOUNDARY_SPC_SYMMETRY_PLANE", kCards, ". p", "ID^ SET"},
    {"BOUNDARY_PRESCRIBED_MOTION_NODE", kCards, kMotion, kMotionOptions},
    {"BOUNDARY_PRESCRIBED_MOTION_SET", kCards, "N . . . . . .;?1.2=9,10,11,12,-9,-10,-11,-12 . . p n n", kMotionOptions},
    {"BOUNDARY_PRESCRIBED_MOTION_RIGID", kCards, "p . . . . . .;?1.2=9,10,11,12,-9,-10,-11,-12 . . p n n", kMotionOptions},
    {"BOUNDARY_PRESCRIBED_MOTION_RIGID_LOCAL", kCards, "p . . . . . .;?1.2=9,10,11,12,-9,-10,-11,-12 . . p n n", kMotionOptions},
    {"BOUNDARY_PRESCRIBED_MOTION_SET_BOX", kCards, "N", "ID^", true},
    {"BOUNDARY_PRESCRIBED_FINAL_GEOMETRY", kCards, "#;n*", "", true, true},
    {"BOUNDARY_PRESCRIBED_ORIENTATION_RIGID_DIRCOS", kCards, "p;", "ID^", true, true},
    {"BOUNDARY_PRESCRIBED_ORIENTATION_RIGID_ANGLES", kCards, "p;", "ID^", true, true},
    {"BOUNDARY_PRESCRIBED_ORIENTATION_RIGID_EULERP", kCards, "p;", "ID^", true, true},
    {"BOUNDARY_PRESCRIBED_ORIENTATION_RIGID_VECTOR", kCards, "p;", "ID^", true, true},
    {"BOUNDARY_PRESCRIBED_ACCELEROMETER_RIGID", kCards, "p;* n", "", true},
    {"BOUNDARY_CYCLIC", kCards, ". . . N N"},
    {"BOUNDARY_SLIDING_PLANE", kCards, "N"},
    {"BOUNDARY_NON_REFLECTING", kCards, "G"},
    {"BOUNDARY_NON_REFLECTING_2D", kCards, "N"},
    {"BOUNDARY_TEMPERATURE_NODE", kCards, "n"},
    {"BOUNDARY_TEMPERATURE_SET", kCards, "N"},
    {"BOUNDARY_CONVECTION_SET", kCards, "G;"},
    {"BOUNDARY_CONVECTION_SEGMENT", kCards, "n4;"},
    {"BOUNDARY_FLUX_SET", kCards, "G", "", true, true},
    {"BOUNDARY_RADIATION_SET", kCards, "G", "", true, true},
    {"BOUNDARY_SPH_SYMMETRY_PLANE"},

    {"CONSTRAINED_NODAL_RIGID_BODY", kCards, "! . N n", "TITLE^ ID^"},
    {"CONSTRAINED_NODAL_RIGID_BODY_SPC", kCards, "! . N n;", "TITLE^ ID^"},
    {"CONSTRAINED_NODAL_RIGID_BODY_INERTIA", kCards, "! . N n;.5 n;;;?2.5=1", "TITLE^ ID^"},
    {"CONSTRAINED_NODAL_RIGID_BODY_SPC_INERTIA", kCards, "! . N n;;.5 n;;;?3.5=1", "TITLE^ ID^"},
    {"CONSTRAINED_EXTRA_NODES_NODE", kCards, "p n"},
    {"CONSTRAINED_EXTRA_NODES_SET", kCards, "p N"},
    {"CONSTRAINED_RIGID_BODIES", kCards, "p p"},
    {"CONSTRAINED_RIGID_BODIES_SET", kCards, "p P"},
    {"CONSTRAINED_RIGID_BODY_STOPPERS", kCards, "p . . P P;"},
    {"CONSTRAINED_JOINT_SPHERICAL", kCards, kJoint, kJointOptions},
    {"CONSTRAINED_JOINT_REVOLUTE", kCards, kJoint, kJointOptions},
    {"CONSTRAINED_JOINT_CYLINDRICAL", kCards, kJoint, kJointOptions},
    {"CONSTRAINED_JOINT_PLANAR", kCards, kJoint, kJointOptions},
    {"CONSTRAINED_JOINT_UNIVERSAL", kCards, kJoint, kJointOptions},
    {"CONSTRAINED_JOINT_TRANSLATIONAL", kCards, kJoint, kJointOptions},
    {"CONSTRAINED_JOINT_LOCKING", kCards, kJoint, kJointOptions},
    {"CONSTRAINED_JOINT_CONSTANT_VELOCITY", kCards, kJoint, kJointOptions},
    {"CONSTRAINED_JOINT_TRANSLATIONAL_MOTOR", kCards, kJointWithParameters, kJointOptions},
    {"CONSTRAINED_JOINT_ROTATIONAL_MOTOR", kCards, kJointWithParameters, kJointOptions},
    {"CONSTRAINED_JOINT_GEARS", kCards, kJointWithParameters, kJointOptions},
    {"CONSTRAINED_JOINT_RACK_AND_PINION", kCards, kJointWithParameters, kJointOptions},
    {"CONSTRAINED_JOINT_PULLEY", kCards, kJointWithParameters, kJointOptions},
    {"CONSTRAINED_JOINT_SCREW", kCards, kJointWithParameters, kJointOptions},
    {"CONSTRAINED_JOINT_STIFFNESS_GENERALIZED", kCards, "# p p;;;", "TITLE^ ID^"},
    {"CONSTRAINED_JOINT_STIFFNESS_FLEXION-TORSION", kCards, "# p p;;;", "TITLE^ ID^"},
    {"CONSTRAINED_JOINT_STIFFNESS_TRANSLATIONAL", kCards, "# p p;;;", "TITLE^ ID^"},
    {"CONSTRAINED_GENERALIZED_WELD_SPOT", kCards, "N;", "ID^ TITLE^"},
    {"CONSTRAINED_GENERALIZED_WELD_FILLET", kCards, "N;", "ID^ TITLE^"},
    {"CONSTRAINED_GENERALIZED_WELD_BUTT", kCards, "N;", "ID^ TITLE^"},
    {"CONSTRAINED_GENERALIZED_WELD_CROSS_FILLET", kCards, "N;;%1.5 n n", "ID^ TITLE^"},
    {"CONSTRAINED_GENERALIZED_WELD_COMBINED", kCards, "N;&1.5;n n", "ID^ TITLE^"},
    {"CONSTRAINED_SPOTWELD", kCards, "n n", "ID^ FILTERED_FORCE+"},
    {"CONSTRAINED_RIVET", kCards, "n n", "ID^"},
    {"CONSTRAINED_NODE_SET", kCards, "N", "ID^"},
    {"CONSTRAINED_NODE_INTERPOLATION", kCards, "n n;n4", "", false, true},
    {"CONSTRAINED_INTERPOLATION", kCards, "# n;* @1.5:0n1N", "", true},
    {"CONSTRAINED_INTERPOLATION_LOCAL", kCards, "# n", "", true, true},
    {"CONSTRAINED_INTERPOLATION_SPOTWELD", kCards, kInterpolatedBeam, "ID^", true, true},
    {"CONSTRAINED_SPR2", kCards, "p p N;;;p4", "", true, true},
    {"CONSTRAINED_SPR3", kCards, kInterpolatedBeam, "", true, true},
    {"CONSTRAINED_LINEAR_GLOBAL", kCards, "#;* n", "", true},
    {"CONSTRAINED_LINEAR_LOCAL", kCards, "#;* n", "", true},
    {"CONSTRAINED_TIED_NODES_FAILURE", kCards, "N"},
    {"CONSTRAINED_TIE-BREAK", kCards, "N N"},
    {"CONSTRAINED_BUTT_WELD", kCards, "N N"},
    {"CONSTRAINED_SHELL_TO_SOLID", kCards, "n N"},
    {"CONSTRAINED_ADAPTIVITY", kCards, "n3"},
    {"CONSTRAINED_LAGRANGE_IN_SOLID", kCards, kCoupling, "TITLE^ ID^ EDGE", true},
    {"CONSTRAINED_BEAM_IN_SOLID", kCards, kCoupling, "TITLE^ ID^ PENALTY", true},
    {"CONSTRAINED_SOLID_IN_SOLID", kCards, kCoupling, "TITLE^ ID^", true},
    {"CONSTRAINED_SHELL_IN_SOLID", kCards, kCoupling, "TITLE^ ID^ PENALTY", true},
    {"CONSTRAINED_EULER_IN_EULER", kCards, "P P"},
    {"CONSTRAINED_GLOBAL"},
    {"CONSTRAINED_LOCAL"},

    {"CONTACT", RuleKind::contact, "", "*"},
    {"CONTACT_1D", kCards, "N N", "", true},
    {"CONTACT_INTERIOR", kCards, "* P8", "ID^ TITLE^"},

    {"DATABASE_ABSTAT", RuleKind::nothing, "", "*"},
    {"DATABASE_ATDOUT"},
    {"DATABASE_AVSFLT"},
    {"DATABASE_BEARING"},
    {"DATABASE_BINARY", RuleKind::nothing, "", "*"},
    {"DATABASE_BNDOUT"},
    {"DATABASE_CURVOUT"},
    {"DATABASE_DCFAIL"},
    {"DATABASE_DEFGEO"},
    {"DATABASE_DEFORC"},
    {"DATABASE_DISBOUT"},
    {"DATABASE_DESTAT"},
    {"DATABASE_ELOUT"},
    {"DATABASE_EXTENT", RuleKind::nothing, "", "*"},
    {"DATABASE_FORMAT"},
    {"DATABASE_FREQUENCY_BINARY", RuleKind::nothing, "", "*"},
    {"DATABASE_GCEOUT"},
    {"DATABASE_GLSTAT", RuleKind::nothing, "", "*"},
    {"DATABASE_H3OUT"},
    {"DATABASE_JNTFORC", RuleKind::nothing, "", "*"},
    {"DATABASE_MATSUM"},
    {"DATABASE_MOVIE"},
    {"DATABASE_MPGS"},
    {"DATABASE_NCFORC"},
    {"DATABASE_NODFOR"},
    {"DATABASE_NODOUT", RuleKind::nothing, "", "*"},
    {"DATABASE_PBSTAT"},
    {"DATABASE_PLLYOUT"},
    {"DATABASE_PRTUBE"},
    {"DATABASE_PYRO"},
    {"DATABASE_RBDOUT"},
    {"DATABASE_RCFORC", RuleKind::nothing, "", "*"},
    {"DATABASE_RWFORC"},
    {"DATABASE_SBTOUT"},
    {"DATABASE_SECFORC", RuleKind::nothing, "", "*"},
    {"DATABASE_SLEOUT"},
    {"DATABASE_SPCFORC"},
    {"DATABASE_SPHMASSFLOW"},
    {"DATABASE_SPHOUT"},
    {"DATABASE_SSSTAT", RuleKind::nothing, "", "MASS_PROPERTY"},
    {"DATABASE_SWFORC"},
    {"DATABASE_TPRINT"},
    {"DATABASE_TRHIST"},
    {"DATABASE_HISTORY_NODE", kCards, "n8"},
    {"DATABASE_HISTORY_NODE_ID", kCards, "n"},
    {"DATABASE_HISTORY_NODE_LOCAL", kCards, "n"},
    {"DATABASE_HISTORY_NODE_LOCAL_ID", kCards, "n;"},
    {"DATABASE_HISTORY_NODE_SET", kCards, "N8"},
    {"DATABASE_HISTORY_NODE_SET_LOCAL", kCards, "N"},
    {"DATABASE_HISTORY_SHELL", kCards, "s8"},
    {"DATABASE_HISTORY_SHELL_ID", kCards, "s"},
    {"DATABASE_HISTORY_SHELL_SET", kCards, "S8"},
    {"DATABASE_HISTORY_BEAM", kCards, "b8"},
    {"DATABASE_HISTORY_BEAM_ID", kCards, "b"},
    {"DATABASE_HISTORY_BEAM_SET", kCards, "B8"},
    {"DATABASE_HISTORY_SOLID", kCards, "h8"},
    {"DATABASE_HISTORY_SOLID_ID", kCards, "h"},
    {"DATABASE_HISTORY_SOLID_SET", kCards, "H8"},
    {"DATABASE_HISTORY_TSHELL", kCards, "t8"},
    {"DATABASE_HISTORY_TSHELL_ID", kCards, "t"},
    {"DATABASE_HISTORY_TSHELL_SET", kCards, "T8"},
    {"DATABASE_HISTORY_DISCRETE", kCards, "d8"},
    {"DATABASE_HISTORY_DISCRETE_ID", kCards, "d"},
    {"DATABASE_HISTORY_DISCRETE_SET", kCards, "D8"},
    {"DATABASE_HISTORY_SEATBELT", kCards, "o8"},
    {"DATABASE_HISTORY_SEATBELT_ID", kCards, "o"},
    {"DATABASE_HISTORY_SPH", kCards, "n8"},
    {"DATABASE_HISTORY_SPH_SET", kCards, "N8"},
    {"DATABASE_CROSS_SECTION_SET", kCards, "N H B S T D", "ID^"},
    {"DATABASE_CROSS_SECTION_PLANE", kCards, "P;", "ID^"},
    {"DATABASE_NODAL_FORCE_GROUP", kCards, "N"},
    {"DATABASE_FSI", kCards, ";* . @3:0P1p2G", "", true},
    {"DATABASE_MASSOUT", kCards, "P"},
    {"DATABASE_TRACER", kCards, ".6 n"},

    {"LOAD_NODE_POINT", kCards, "n .4 n3", "ID^"},
    {"LOAD_NODE_SET", kCards, "N .4 n3", "ID^"},
    {"LOAD_SHELL_ELEMENT", kCards, "s", "ID^"},
    {"LOAD_SHELL_SET", kCards, "S", "ID^"},
    {"LOAD_SEGMENT", kCards, ". . . n5;?1.8!=0 n3", "ID^"},
    {"LOAD_SEGMENT_SET", kCards, "G", "ID^"},
    {"LOAD_BODY_X"},
    {"LOAD_BODY_Y"},
    {"LOAD_BODY_Z"},
    {"LOAD_BODY_RX"},
    {"LOAD_BODY_RY"},
    {"LOAD_BODY_RZ"},
    {"LOAD_BODY_VECTOR"},
    {"LOAD_BODY_PARTS", kCards, "P"},
    {"LOAD_BODY_GENERALIZED", kCards, "rn;"},
    {"LOAD_BODY_GENERALIZED_SET_NODE", kCards, "N;"},
    {"LOAD_BODY_GENERALIZED_SET_PART", kCards, "P;"},
    {"LOAD_GRAVITY_PART", kCards, "p"},
    {"LOAD_GRAVITY_PART_SET", kCards, "P"},
    {"LOAD_RIGID_BODY", kCards, "p .4 n3"},
    {"LOAD_BEAM_ELEMENT", kCards, "b"},
    {"LOAD_BEAM_SET", kCards, "B"},
    {"LOAD_MASK", kCards, "p", "", true, true},
    {"LOAD_BLAST"},
    {"LOAD_BLAST_ENHANCED"},
    {"LOAD_BLAST_SEGMENT", kCards, ". n4", "", false, true},
    {"LOAD_BLAST_SEGMENT_SET", kCards, ". G", "", false, true},
    {"LOAD_BRODE"},
    {"LOAD_DENSITY_DEPTH", kCards, "P"},
    {"LOAD_STIFFEN_PART", kCards, "p"},
    {"LOAD_STIFFEN_PART_SET", kCards, "P"},
    {"LOAD_HEAT_GENERATION_SET", kCards, "H"},
    {"LOAD_HEAT_GENERATION_SOLID", kCards, "h"},
    {"LOAD_THERMAL_CONSTANT", kCards, "N N;"},
    {"LOAD_THERMAL_CONSTANT_NODE", kCards, "n"},
    {"LOAD_THERMAL_LOAD_CURVE"},
    {"LOAD_THERMAL_VARIABLE", kCards, "N N;"},
    {"LOAD_THERMAL_VARIABLE_NODE", kCards, "n"},

    {"INITIAL_VELOCITY", kCards, "N N;;?1.2!=0"},
    {"INITIAL_VELOCITY_NODE", kCards, "n"},
    {"INITIAL_VELOCITY_RIGID_BODY", kCards, "p"},
    {"INITIAL_VELOCITY_GENERATION", kCards, "@2:0z1P2p3N;"},
    {"INITIAL_VELOCITY_GENERATION_START_TIME"},
    {"INITIAL_STRESS_SHELL", RuleKind::initial, "s"},
    {"INITIAL_STRESS_SHELL_SET", RuleKind::initial, "S"},
    {"INITIAL_STRAIN_SHELL", RuleKind::initial, "s"},
    {"INITIAL_STRAIN_SHELL_SET", RuleKind::initial, "S"},
    {"INITIAL_STRESS_SOLID", RuleKind::initial, "h"},
    {"INITIAL_STRESS_SOLID_SET", RuleKind::initial, "H"},
    {"INITIAL_STRAIN_SOLID", RuleKind::initial, "h"},
    {"INITIAL_STRAIN_SOLID_SET", RuleKind::initial, "H"},
    {"INITIAL_STRESS_BEAM", RuleKind::initial, "b"},
    {"INITIAL_STRESS_TSHELL", RuleKind::initial, "t"},
    {"INITIAL_STRAIN_TSHELL", RuleKind::initial, "t"},
    {"INITIAL_STRESS_SECTION", kCards, ". . . P"},
    {"INITIAL_AXIAL_FORCE_BEAM", kCards, "B"},
    {"INITIAL_VOID_PART", kCards, "p"},
    {"INITIAL_VOID_SET", kCards, "P"},
    {"INITIAL_TEMPERATURE_NODE", kCards, "n"},
    {"INITIAL_TEMPERATURE_SET", kCards, "N"},
    {"INITIAL_DETONATION", kCards, "p-P", "GEOMETRY", false, true},
    {"INITIAL_MOMENTUM", kCards, "h"},
    {"INITIAL_FOAM_REFERENCE_GEOMETRY", kCards, "n", "", false, false, kEightWide},

    {"RIGIDWALL_PLANAR", kCards, "N N;", kWallOptions},
    {"RIGIDWALL_GEOMETRIC_FLAT", kCards, "N N;;", "MOTION+ DISPLAY+! INTERIOR ID^ TITLE^", true},
    {"RIGIDWALL_GEOMETRIC_PRISM", kCards, "N N;;", "MOTION+ DISPLAY+! INTERIOR ID^ TITLE^", true},
    {"RIGIDWALL_GEOMETRIC_CYLINDER", kCards, "N N;;", "MOTION+ DISPLAY INTERIOR ID^ TITLE^", true},
    {"RIGIDWALL_GEOMETRIC_SPHERE", kCards, "N N;;", "MOTION+ DISPLAY+! INTERIOR ID^ TITLE^", true},

    {"DEFINE_BOX", RuleKind::nothing, "", "LOCAL TITLE"},
    {"DEFINE_BOX_ADAPTIVE", RuleKind::nothing, "", "LOCAL TITLE"},
    {"DEFINE_CONNECTION_PROPERTIES", RuleKind::nothing, "", "*"},
    {"DEFINE_COORDINATE_NODES", kCards, "# n3", "TITLE^"},
    {"DEFINE_COORDINATE_SYSTEM", RuleKind::nothing, "", "TITLE"},
    {"DEFINE_COORDINATE_VECTOR", RuleKind::nothing, "", "TITLE"},
    {"DEFINE_CURVE", RuleKind::nothing, "", "TITLE"},
    {"DEFINE_CURVE_BOX_ADAPTIVITY", RuleKind::nothing, "", "*"},
    {"DEFINE_CURVE_DUPLICATE", RuleKind::nothing, "", "*"},
    {"DEFINE_CURVE_SMOOTH", RuleKind::nothing, "", "*"},
    {"DEFINE_CURVE_STRESS", RuleKind::nothing, "", "*"},
    {"DEFINE_CURVE_ENTITY", RuleKind::nothing, "", "*"},
    {"DEFINE_ELEMENT_DEATH_BEAM", kCards, "b"},
    {"DEFINE_ELEMENT_DEATH_BEAM_SET", kCards, "B"},
    {"DEFINE_ELEMENT_DEATH_SHELL", kCards, "s"},
    {"DEFINE_ELEMENT_DEATH_SHELL_SET", kCards, "S"},
    {"DEFINE_ELEMENT_DEATH_SOLID", kCards, "h"},
    {"DEFINE_ELEMENT_DEATH_SOLID_SET", kCards, "H"},
    {"DEFINE_ELEMENT_DEATH_THICK_SHELL", kCards, "t"},
    {"DEFINE_ELEMENT_DEATH_THICK_SHELL_SET", kCards, "T"},
    {"DEFINE_FRICTION", kCards, "#;* @7:0p1pTPPp @8:0p1pTPPp", "", true},
    {"DEFINE_FUNCTION_TABULATED", RuleKind::nothing, "", "*"},
    {"DEFINE_HEX_SPOTWELD_ASSEMBLY", kCards, "#;* h8", "N 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16", true},
    {"DEFINE_PLANE", RuleKind::nothing, "", "TITLE"},
    {"DEFINE_REGION", RuleKind::nothing, "", "TITLE"},
    {"DEFINE_SD_ORIENTATION", kCards, "# .4 n n", "TITLE^"},
    {"DEFINE_SPOTWELD_FAILURE", RuleKind::nothing, "", "*"},
    {"DEFINE_SPOTWELD_RUPTURE_PARAMETER", kCards, "p", "", true, true},
    {"DEFINE_STAGED_CONSTRUCTION_PART", kCards, "p"},
    {"DEFINE_STAGED_CONSTRUCTION_PART_SET", kCards, "P"},
    {"DEFINE_CONSTRUCTION_STAGES"},
    {"DEFINE_TABLE", RuleKind::nothing, "", "*"},
    {"DEFINE_TRANSFORMATION", RuleKind::transformation, "", "TITLE"},
    {"DEFINE_VECTOR", RuleKind::nothing, "", "TITLE"},
    {"DEFINE_VECTOR_NODES", kCards, "# n n", "TITLE^"},

    {"DEFORMABLE_TO_RIGID", kCards, "@3:0pPpTP p"},
    {"DEFORMABLE_TO_RIGID_AUTOMATIC", kCards, ";.3;%2.5 @3:0pPpTP p;%2.6 @2:0pPpTP", "", true},
    {"DEFORMABLE_TO_RIGID_INERTIA", kCards, "p;;"},

    {"AIRBAG_SIMPLE_PRESSURE_VOLUME", kCards, "@2:0G_P . p", "ID^", true},
    {"AIRBAG_SIMPLE_AIRBAG_MODEL", kCards, "@2:0G_P . p", "ID^", true},
    {"AIRBAG_ADIABATIC_GAS_MODEL", kCards, "@2:0G_P . p", "ID^", true},
    {"AIRBAG_WANG_NEFSKE", kCards, "@2:0G_P . p", "ID^", true, true},
    {"AIRBAG_LOAD_CURVE", kCards, "@2:0G_P . p", "ID^", true},
    {"AIRBAG_LINEAR_FLUID", kCards, "@2:0G_P . p", "ID^", true},
    {"AIRBAG_HYBRID", kCards, "@2:0G_P . p", "ID^ JETTING CM CHEMKIN", true, true},
    {"AIRBAG_PARTICLE", kCards, "@2:0p1P . @4:0p1P", "ID^", true, true},
    {"AIRBAG_INTERACTION", kCards, ".4 p"},
    {"AIRBAG_REFERENCE_GEOMETRY", kCards, "n", "", false, false, kEightWide},
    {"AIRBAG_SHELL_REFERENCE_GEOMETRY", kCards, "s p n4", "", false, false, kEightWide},

    {"SENSOR_DEFINE_NODE", kCards, "# n n"},
    {"SENSOR_DEFINE_NODE_SET", kCards, "# N N"},
    {"SENSOR_DEFINE_ELEMENT", kCards, "# @3:BbSsDdTt_e", "", false, true},
    {"SENSOR_DEFINE_ELEMENT_SET", kCards, "# E", "", false, true},
    {"SENSOR_DEFINE_FORCE"},
    {"SENSOR_DEFINE_CALC-MATH"},
    {"SENSOR_SWITCH", RuleKind::nothing, "", "*"},

    {"ALE_REFERENCE_SYSTEM_GROUP", kCards, "@2:0P1p2N3G", "", true},
    {"ALE_REFERENCE_SYSTEM_NODE", kCards, "#;n8", "", true},
    {"ALE_REFERENCE_SYSTEM_CURVE", RuleKind::nothing, "", "*"},
    {"ALE_REFERENCE_SYSTEM_SWITCH", RuleKind::nothing, "", "*"},
    {"ALE_MULTI-MATERIAL_GROUP", kCards, "@2:0P1p"},
    {"FREQUENCY_DOMAIN_SSD", kCards, ";;.4 @6:0N1S2H3p4P;* @2:0n1N2G", "", true, true},
    {"DAMPING_GLOBAL"},
    {"DAMPING_PART_MASS", kCards, "p;?1.4=1"},
    {"DAMPING_PART_MASS_SET", kCards, "P;?1.4=1"},
    {"DAMPING_PART_STIFFNESS", kCards, "p"},
    {"DAMPING_PART_STIFFNESS_SET", kCards, "P"},
    {"DAMPING_RELATIVE", kCards, ". . p P"},
    {"DAMPING_FREQUENCY_RANGE", kCards, ". . . P . p"},
    {"DAMPING_FREQUENCY_RANGE_DEFORM", kCards, ". . . P"},
    {"INTERFACE_COMPONENT_NODE", kCards, "N . n"},
    {"INTERFACE_COMPONENT_SEGMENT", kCards, "G . n"},
    {"INTERFACE_SPRINGBACK_LSDYNA", kCards, "P;* n", "NOTHICKNESS THICKNESS", true},
    {"TERMINATION_NODE", kCards, "n"},
    {"TERMINATION_BODY", kCards, "p"},
    {"TERMINATION_CONTACT"},
    {"TERMINATION_CURVE"},
    {"TERMINATION_SENSOR"},
    {"TERMINATION_DELETED_SHELLS", kCards, "p"},
    {"TERMINATION_DELETED_SHELLS_SET", kCards, "P"},
    {"TERMINATION_DELETED_SOLIDS", kCards, "p"},
    {"TERMINATION_DELETED_SOLIDS_SET", kCards, "P"},
    {"INTEGRATION_SHELL", kCards, ";%1.2 . . p"},
    {"INTEGRATION_BEAM", kCards, "", "", true, true},

    // Materials name other materials and curves; these name parts too.
    {"MAT", RuleKind::nothing, "", "*"},
    {"MAT_ADD_THERMAL_EXPANSION", kCards, "p"},
    {"MAT_ADD_COHESIVE", kCards, "p"},
    {"MAT_NONLOCAL", kCards, ". p", "", true},
    {"MAT_ADD_AIRBAG_POROSITY_LEAKAGE"},
    {"EOS", RuleKind::nothing, "", "*"},
    {"SECTION", RuleKind::nothing, "", "*"},
    {"HOURGLASS", RuleKind::nothing, "", "*"},
    {"CONTROL", RuleKind::nothing, "", "*"},
    {"CONTROL_FORMING", RuleKind::cards, "", "*", true, true},
    {"CONTROL_MPP_DECOMPOSITION", RuleKind::cards, "", "*", true, true},
    {"CONTROL_MPP_DECOMPOSITION_DISTRIBUTE_ALE_ELEMENTS"},
    {"CONTROL_MPP_DECOMPOSITION_AUTOMATIC"},
    {"CONTROL_MPP_DECOMPOSITION_TRANSFORMATION"},
    {"CONTROL_MPP_DECOMPOSITION_CHECK_SPEED"},
    {"CONTROL_MPP_DECOMPOSITION_NUMPROC"},
    {"CONTROL_MPP_DECOMPOSITION_METHOD"},
    {"CONTROL_MPP_DECOMPOSITION_SHOW"},
    {"CONTROL_IMPLICIT_MODES", RuleKind::cards, "N", "TITLE", true},
    {"CONTROL_STAGED_CONSTRUCTION", RuleKind::cards, "", "*", true, true},
    {"CONTROL_REMESHING", RuleKind::cards, "", "*", true, true},
    {"CONTROL_ADAPTIVE_CURVE", RuleKind::cards, "", "*", true, true},
    {"CONTROL_COARSEN", RuleKind::cards, "", "*", true, true},
    {"CONTROL_DISCRETE_ELEMENT"},
    {"COMMENT"},
    {"TITLE"},
    {"KEYWORD", RuleKind::nothing, "", "*"},
    {"UNIT"},
    {"CASE", RuleKind::nothing, "", "*"},
    {"PARAMETER", RuleKind::nothing, "", "*"},
    {"INCLUDE"},
    {"INCLUDE_PATH", RuleKind::nothing, "", "RELATIVE"},
    {"INCLUDE_TRANSFORM"},
};

using RuleIndex = std::map<std::string_view, const ReferenceRule*>;

const RuleIndex& rule_index() {
  static const RuleIndex index = [] {
    RuleIndex made;
    for (const ReferenceRule& rule : kRules) made.emplace(rule.keyword, &rule);
    return made;
  }();
  return index;
}

/// Removes the number at the begin of a text and returns it.
std::uint8_t cut_number(std::string_view& text) {
  unsigned number = 0;
  while (!text.empty() && text.front() >= '0' && text.front() <= '9' && number < 100) {
    number = number * 10 + static_cast<unsigned>(text.front() - '0');
    text.remove_prefix(1);
  }
  return static_cast<std::uint8_t>(number);
}

/// Removes "1.2" from the begin of a text and returns card and field; "2" alone is a field of this card (card 0).
void cut_place(std::string_view& text, std::uint8_t& card, std::uint8_t& field) {
  card = 0;
  field = cut_number(text);
  if (text.empty() || text.front() != '.') return;
  text.remove_prefix(1);
  card = field;
  field = cut_number(text);
}

std::string_view cut_word(std::string_view& text, std::string_view separators) {
  const std::size_t first = std::min(text.find_first_not_of(separators), text.size());
  text.remove_prefix(first);
  const std::size_t end = std::min(text.find_first_of(separators), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

void read_condition(std::string_view word, CardRule& card) {
  cut_place(word, card.condition_card, card.condition_field);
  card.unless = !word.empty() && word.front() == '!';
  word.remove_prefix(card.unless ? 2 : 1);
  while (!word.empty()) {
    const bool negative = word.front() == '-';
    if (negative) word.remove_prefix(1);
    const std::int64_t value = cut_number(word);
    card.condition_values.push_back(negative ? -value : value);
    if (!word.empty()) word.remove_prefix(1);
  }
}

/// Adds the fields that a word describes, from `field` on. Returns the field behind them.
std::uint8_t read_field(std::string_view word, std::uint8_t field, CardRule& card) {
  const char first = word.front();
  word.remove_prefix(1);
  FieldRule rule;
  rule.field = field;
  if (first == '.') return static_cast<std::uint8_t>(field + std::max<std::uint8_t>(1, cut_number(word)));
  if (first == '#' || first == '!') {
    rule.kind = first == '#' ? FieldRule::Kind::own_id : FieldRule::Kind::own_part;
  } else if (first == '@') {
    rule.kind = FieldRule::Kind::typed;
    cut_place(word, rule.type_card, rule.type_field);
    rule.types = word.substr(1);
  } else if (first == 'r') {
    rule.kind = FieldRule::Kind::range;
    referred_of(word.front(), rule.referred);
    card.fields.push_back(rule);
    return static_cast<std::uint8_t>(field + 2);
  } else {
    referred_of(first, rule.referred);
    rule.has_negative = !word.empty() && word.front() == '-' && referred_of(word[1], rule.negative);
    const int count = rule.has_negative ? 1 : std::max<int>(1, cut_number(word));
    for (int i = 0; i < count; ++i, ++rule.field) card.fields.push_back(rule);
    return rule.field;
  }
  card.fields.push_back(rule);
  return static_cast<std::uint8_t>(field + 1);
}

CardRule compile_card(std::string_view text, std::string_view separators) {
  CardRule card;
  std::uint8_t field = 0;
  for (std::string_view word = cut_word(text, separators); !word.empty(); word = cut_word(text, separators)) {
    const char first = word.front();
    std::string_view rest = word.substr(1);
    if (first == '?') {
      read_condition(rest, card);
    } else if (first == '%' || first == '&') {
      card.repeat = first == '%' ? CardRule::Repeat::count : CardRule::Repeat::group;
      cut_place(rest, card.count_card, card.count_field);
    } else if (first == '*') {
      card.repeat = CardRule::Repeat::to_the_end;
    } else {
      field = read_field(word, field, card);
    }
  }
  return card;
}

/// Whether `option` is one of the rule's options. Appends the cards that it adds.
bool add_option(std::string_view known, std::string_view option, std::vector<CardRule>& cards, int& headers) {
  for (std::string_view entry = cut_word(known, " "); !entry.empty(); entry = cut_word(known, " ")) {
    const std::size_t name_end = std::min(entry.find_first_of("^+"), entry.size());
    if (entry.substr(0, name_end) != option) continue;
    std::string_view adds = entry.substr(name_end);
    if (adds == "^") ++headers;
    while (!adds.empty() && adds.front() == '+') {
      adds.remove_prefix(1);
      cards.push_back(compile_card(adds.substr(0, std::min(adds.find('+'), adds.size())), ","));
    }
    return true;
  }
  return false;
}

/// Options may have two words.
bool add_options(std::string_view known, std::string_view options, std::vector<CardRule>& cards, int& headers) {
  if (known == "*") return true;
  while (!options.empty()) {
    options.remove_prefix(1);  // '_'
    std::size_t end = options.size();
    while (end != std::string_view::npos && end > 0 && !add_option(known, options.substr(0, end), cards, headers))
      end = options.rfind('_', end - 1);
    if (end == std::string_view::npos || end == 0) return false;
    options.remove_prefix(end);
  }
  return true;
}

}  // namespace

bool referred_of(char letter, Referred& referred) {
  constexpr std::string_view kLetters = "nsbhtdmoepNSBHTDPGE";
  constexpr Referred kMeant[] = {Referred::node,        Referred::shell,       Referred::beam,       Referred::solid,
                                 Referred::tshell,      Referred::discrete,    Referred::mass,       Referred::other,
                                 Referred::any_element, Referred::part,        Referred::node_set,   Referred::shell_set,
                                 Referred::beam_set,    Referred::solid_set,   Referred::tshell_set, Referred::discrete_set,
                                 Referred::part_set,    Referred::segment_set, Referred::element_set};
  const std::size_t at = kLetters.find(letter);
  if (at == std::string_view::npos) return false;
  referred = kMeant[at];
  return true;
}

const ReferenceRule* find_reference_rule(std::string_view keyword, std::string_view& options) {
  const RuleIndex& index = rule_index();
  for (std::size_t end = keyword.size(); end > 0;) {
    const auto found = index.find(keyword.substr(0, end));
    if (found != index.end()) {
      options = keyword.substr(end);
      return found->second;
    }
    const std::size_t before = keyword.rfind('_', end - 1);
    end = before == std::string_view::npos ? 0 : before;
  }
  return nullptr;
}

bool compile(const ReferenceRule& rule, std::string_view options, std::vector<CardRule>& cards, int& headers) {
  cards.clear();
  std::string_view rest = rule.cards;
  headers = rest.substr(0, 1) == "^" ? 1 : 0;
  rest.remove_prefix(static_cast<std::size_t>(headers));
  while (true) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    cards.push_back(compile_card(rest.substr(0, end), " "));
    if (end == rest.size()) break;
    rest.remove_prefix(end + 1);
  }
  return add_options(rule.options, options, cards, headers);
}

}  // namespace prismesh::mesh::deck::lsdyna
