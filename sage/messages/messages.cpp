#include "sage/messages/messages.hpp"

#include <algorithm>

namespace sage {

namespace {

// By the first digit of the codes.
constexpr const char* kSections[] = {
    "S1: files, cards and layouts",
    "S2: what the cards say together, until there is a model",
    "S3: a legal model that may not be meant",
    "S4: refining, grading and mid-side nodes",
    "S5: the analysis",
    "S6: results, checkpoints and what is made of them",
    "S7: decks of other programs, meshes, and writing for others",
    "S8: pieces from outside of the program",
    "S9: the command line",
};

constexpr MessageEntry kMessages[] = {
    // S1: files, cards and layouts.
    {"S101", "a file can't be read",
     "The file does not exist under this name, is a folder, or may not be read by this user. Names are "
     "taken from the folder in which the command is given, not from the folder of the deck.",
     "Check name and folder (ls) and the rights of the file; the full path works from everywhere."},
    {"S102", "a file is too large",
     "A deck may have 2 GiB, a layout 16 MiB; a pipe or a device that never ends is cut off at the same "
     "size. A deck of 5 million nodes is still far below that.",
     "Look whether the name is that of a result, an archive or a device. A text that has grown by "
     "mistake (one card repeated without end) is best written again."},
    {"S103", "a file is empty",
     "The file has no card at all: a copy that failed, a full disk at the time it was written, or an "
     "editor that has not saved yet.",
     "Copy or write the file again; ls -l shows its size."},
    {"S104", "a file is no text of cards",
     "A deck is plain text, one card a line. This file is binary, UTF-16 text (as some Windows programs "
     "write), or a document of a word processor, a spreadsheet or an archive.",
     "Save it as plain text (ASCII or UTF-8) from the program that made it; unpack an archive first. A "
     "result file (.h5) belongs to sagefe plot, a mesh (.msh) to sagefe convert."},
    {"S105", "no layout fits the deck",
     "Every layout that is built in was tried: none finds its own marks in the deck, and the first cards "
     "are not those of sage1. The deck is of a program, or of a version of one, that is not known here.",
     "Name the layout if you know it (--layout NAME or a file). If nobody knows it, sagefe layout guess "
     "DECK writes a first layout, and docs/manual/own_layout.md says how to finish it."},
    {"S106", "a deck of a program with another purpose",
     "Its cards are those of a program for heat, vibration, consolidation, plates or three dimensions, which "
     "this program does not compute.",
     "If the guess is wrong, name the layout with --layout. Otherwise only its mesh can be used: export "
     "it to Gmsh (.msh) and take it from there with sagefe convert."},
    {"S107", "another layout reads the deck without mistakes",
     "The deck has mistakes under the layout it was read with, and none under another one: it was "
     "probably written for that other program.",
     "Run it again with --layout and the name in the message."},
    {"S108", "the deck was read with the standard layout",
     "The deck shows the marks of no other program, so it was read as sage1, and then had mistakes. They "
     "may be mistakes of the deck or mean that it is of another layout.",
     "If the deck was made for sage1, mend the cards that the other messages show. Otherwise name its "
     "layout with --layout."},
    {"S109", "more messages of the same kind",
     "Only the first messages of a kind are shown: one wrong count or one shifted column often causes "
     "hundreds of them.",
     "Mend the first one shown and check again; the rest often goes with it."},
    {"S110", "a card is missing",
     "The layout expects a card here, and the deck has another one, its closing card, or nothing more. "
     "Most often a count on the control card, or in front of a list, is larger than the number of cards "
     "that follow; or a card was lost when the deck was edited.",
     "Compare the count that the message names with the cards (sagefe echo DECK shows each card as it "
     "was read), then correct the count or add the card."},
    {"S111", "a count and its cards do not agree",
     "A card reads like one of another kind: the count that announces this kind is too large or too "
     "small, or a card has too few or too many lines.",
     "Count the cards of the kind in the message and correct the count it names. Where that count is "
     "right, one further up is wrong: mend the first message first."},
    {"S112", "a card has no place here",
     "The card's name is known, but not at this place of the deck, or the deck was complete before it.",
     "Move the card to the place that docs/manual/deck_format.md (or the layout) gives it, or take it "
     "out."},
    {"S113", "lines behind the end of the deck",
     "All cards that the counts announce were read, and more lines follow. They are ignored. Notes of "
     "the deck's author are harmless; cards there are not computed.",
     "If they are cards, a count above is too small. If they are notes, nothing is to be done."},
    {"S114", "the last card is not marked as the last",
     "The layout closes a list by a mark on its last card (such as a negative number); here the list "
     "ended without it.",
     "Add the mark to the last card of the list, or the cards that are missing behind it."},
    {"S115", "a value is missing",
     "A field that must be given is blank or the line ends before it. On a fixed-format card a value "
     "that stands a few columns to the left or right is in another field.",
     "Write the value into the columns that the message shows under its ruler; sagefe echo DECK shows "
     "what every field holds."},
    {"S116", "a card does not read what it must",
     "The layout wants a fixed word or number here, by which a card is told from others. Something else "
     "means that a card is missing, stands twice, or that the deck is of another layout.",
     "Look at the cards before this one first: a wrong count shifts all that follow. Then correct the "
     "word."},
    {"S117", "a code is unknown",
     "The field holds a code number or word that the layout does not know: a slip, or an option of the "
     "program the deck was written for that has no counterpart.",
     "Take one of the codes that the message lists; for a code of a program of your own add it to the "
     "map of the layout."},
    {"S118", "a value is not allowed",
     "The field may only hold certain values, or values between limits, and this one is outside. A "
     "decimal point in the wrong place or a value in a neighbour's columns are the usual reasons.",
     "Correct the value; the message says what is allowed. With a unit in mind: the deck's units are "
     "those of its unit card."},
    {"S119", "numbers that nothing reads",
     "A list-directed READ takes as many values as its list is long; more stand on the line. A count "
     "before it is too small, a value too many stands before it, or the deck is of another program. "
     "Values that should be used are then lost.",
     "Correct the count, or the values. Where numbers are left over on purpose (as remarks) end the "
     "values by a slash (/)."},
    {"S120", "a field is no number",
     "The columns of a number hold a character that belongs to none: a letter O for a zero, a second "
     "point, a comma, or part of the neighbouring field. Tabs move everything behind them.",
     "The carets under the card show the columns: correct the value or move it into its columns. Replace "
     "tabs by blanks."},
    {"S121", "a number is not finite",
     "NaN, Inf or an exponent beyond 1e308 was read. Such numbers come from a spreadsheet or a program "
     "that wrote the deck after a division by zero.",
     "Correct the value where the deck was made."},
    {"S122", "a blank inside a number",
     "A blank separates the digits of one number. Fortran skips the blank or reads it as zero, depending "
     "on the layout: 1 5 is 15 or 105. Mostly the card is shifted by a column, and one number spreads "
     "over two fields.",
     "Move the values into their columns. If the number is right as it is, write it without a blank."},
    {"S123", "a comma ends a field",
     "In a fixed-format card a comma ends the field early, and the next field starts right behind it, "
     "not at its columns.",
     "Remove the comma, or separate all values of the card by commas."},
    {"S124", "a number in an unusual form",
     "The exponent letter Q is read by some compilers only, and a lone sign or point reads as 0. The message "
     "gives the way in which it was read.",
     "Write the number with E or D, or a 0 where zero is meant."},
    {"S125", "blanks count as zeros",
     "Under this layout blanks inside a numeric field are zeros (Fortran's BZ): 15 with two blanks "
     "behind it in a field of four is 1500. Editors that cut off blanks at the end of a line change such "
     "decks.",
     "Right-align integers in their fields and give real numbers a point."},
    {"S126", "decimals by the format",
     "A number without a point takes its last digits as decimals, as F10.3 says: 12345 reads as 12.345. "
     "In old decks that is meant; in new ones seldom.",
     "Write the point. If the number is right as it was read, nothing is to be done."},
    {"S127", "a blank field reads as its default",
     "The field was left blank and has a value that is taken then. Other cards of the kind give one, or "
     "the layout wants it told.",
     "If the default is not what you mean, write the value."},
    {"S128", "a value runs across a border of fields",
     "Digits stand on both sides of a border between fields, or behind the last one: the card is "
     "probably shifted by a column, and what was read is a part of the number that was meant.",
     "Move the values into their columns; sagefe echo DECK shows ruler and fields."},
    {"S129", "characters beyond the last field are ignored",
     "Text behind the last field of a card, or beyond the last column of the layout, is not read. "
     "Remarks there are usual in old decks.",
     "Nothing, where it is a remark. If it is a value, move it into its columns."},
    {"S130", "a sequence number is read as data",
     "In columns 73-80 old decks carry sequence numbers of punched cards. On this card the fields reach "
     "into those columns, so that the number is taken for data.",
     "Remove the sequence numbers, or set sequence_columns of the layout to those the deck uses."},
    {"S131", "a computed value fails",
     "The layout computes a value from others by an expression, and the result is no number (a division "
     "by zero, a root of a negative number) or no integer where one is needed. The cards that go into it "
     "hold values nobody thought of when the layout was written.",
     "Look at the values of the fields in the expression (sagefe layout check LAYOUT DECK shows them), "
     "then correct the card or the expression."},
    {"S132", "reading stopped here",
     "After a mistake by which all that follows would be misread, the rest of the deck is not looked at, "
     "in order not to print a page of messages that mean nothing.",
     "Mend the mistake reported before, then check again."},
    {"S133", "a name or title runs into the next field",
     "The text is longer than its field, and a number field behind it reads what runs over.",
     "Shorten the text so that it ends with its field."},
    {"S134", "numbers behind the last field",
     "The card has fewer fields than numbers: the last ones are not read. A value too many stands on the card, "
     "it "
     "is shifted, or it is of another program's layout.",
     "Take the numbers out or move them into their fields. A remark that is meant there begins with a word."},
    {"S140", "there is no layout of this name",
     "--layout takes the name of a layout that is built in or the path of a layout file. Neither was "
     "found.",
     "Take a name from the list in the message, or check the path."},
    {"S141", "a layout file is no TOML",
     "The file breaks the rules of TOML: a bracket or a quote is not closed, a key stands twice, or text "
     "is not in quotes.",
     "Mend the line in the message. FORMATs and expressions are texts in quotes; "
     "docs/manual/own_layout.md shows every kind of line."},
    {"S142", "a FORMAT of a layout is wrong",
     "The FORMAT of a card does not follow Fortran's rules, or has other fields than the card lists: "
     "each name in fields needs one edit descriptor of its kind (I for integer, F or E for real, A for "
     "text).",
     "Correct the FORMAT at the character given, or the list of fields. Repetition such as 8F10.0 counts "
     "as eight fields."},
    {"S143", "an entry of a layout is wrong",
     "A key of the layout is unknown, missing, or holds a value of another kind, or two entries "
     "contradict each other. An unknown key is rejected since a typing error would otherwise change the "
     "reading without a word.",
     "Correct the entry on that line; docs/manual/own_layout.md lists all keys with what they take."},
    {"S146", "an expression of a layout is wrong",
     "A count, a condition or a value is an expression of fields of cards that stand before it. This one "
     "can't be read, uses a name that no earlier card has, or gives a text where a number is needed.",
     "Correct the expression: CARD.FIELD for values, the functions of docs/manual/own_layout.md, texts "
     "in single quotes."},
    {"S147", "a name of a layout means nothing to the model",
     "Cards and fields reach the model by their names. This name is used by nothing, or a card or field "
     "that every model needs is missing: values would be read and then lost.",
     "Correct the name (the message gives near ones), rename with as = \"...\", or mark what is not "
     "needed: ignored = true."},
    {"S148", "a draft of a layout can't make a model",
     "sagefe layout guess writes drafts, in which names and codes are guesses. A draft can show a deck, "
     "but nothing may be computed from guesses.",
     "Finish the layout (docs/manual/layout_guess.md), then take out its line draft = true."},
    {"S149", "deck and layout are exchanged", "sagefe layout check takes the layout first, then the deck.",
     "Exchange the two names."},

    {"S150", "a model file is no TOML",
     "The text breaks the rules of TOML at this place: a quote or bracket that is not closed, a key that "
     "stands twice, "
     "a value that TOML has not.",
     "Correct the line; https://toml.io shows the format on one page, docs/manual/model_file.md what stands in "
     "it."},
    {"S151", "a model file has a key that means nothing",
     "The table has no key of this name. Keys are the names of the fields of a card, and for a material the "
     "parameters "
     "of its law.",
     "Take one of the keys that the message lists; docs/manual/model_file.md says what each is for."},
    {"S152", "a value of a model file is of another kind",
     "A number, a text in quotes, true or false, a list in brackets or a table is wanted here, and something "
     "else "
     "stands there.",
     "Write what the message asks for; docs/manual/model_file.md has an example of every kind."},
    {"S153", "a model file names something that there is not",
     "The law, element, formulation, solver, material, group or choice of this name does not exist, or several "
     "have "
     "it.",
     "Take one of the names in the message; `sagefe list` shows laws, elements and solvers."},
    {"S154", "a unit of a model file does not fit",
     "A number bears a unit that the program does not know, or that measures something else than the value.",
     "Write a unit of the same kind, such as \"50 MPa\" for a stress, or the number alone in the model's own "
     "unit."},
    {"S155", "a model file lacks something",
     "A table lacks a key without which it has no meaning, or the model a table.",
     "Add the key or table that the message names; docs/manual/model_file.md."},
    // S2: what the cards say together, until there is a model.
    {"S201", "a node is not defined",
     "A card names a node that no node card, line or block makes. With generated nodes a step that is "
     "off by one leaves gaps.",
     "Correct the number, or the generation that should make the node; sagefe echo DECK shows how each card "
     "was "
     "read."},
    {"S202", "an element is not defined",
     "A card (pressure, removal, strength) names an element that no element card or block makes.",
     "Correct the number or the block; element numbers of a block run along its rows."},
    {"S203", "a group is not defined",
     "A card names a group that no group card defines. Lists of groups that a stage activates or removes, and "
     "initial stress cards, hold group numbers, not element numbers.",
     "Correct the number or add the group card."},
    {"S204", "a material is not defined", "A group names a material number that no material card has.",
     "Correct the material number on the group card, or add the material."},
    {"S205", "a number is given twice",
     "Two nodes, elements, groups or materials bear the same number. The second would replace the first "
     "without a word; often a block and a single card overlap.",
     "Number one of them anew, or remove the card that is too many."},
    {"S206", "a number is out of range",
     "Nodes, elements, groups and materials are numbered from 1 on; a zero or negative number is a blank "
     "field or a shifted card, and a block must not run beyond the largest number.",
     "Give a number of 1 or more."},
    {"S207", "a value must not be negative",
     "Counts, steps, spacing ratios, areas and limits are zero or more; zero or blank often means the "
     "default.",
     "Correct the sign or the columns. Where a direction is meant, look up the field that says it in "
     "docs/manual/deck_format.md."},
    {"S208", "a value is too large to compute with",
     "Numbers beyond 1e100 overflow when they are squared. No length, force or stiffness of soil comes "
     "near it: such a number marks a field without value in some programs.",
     "Correct the value; for \"very stiff\" take a modulus 1e3 to 1e6 times that of the neighbours."},
    {"S209", "a range of numbers does not work out",
     "First, last and step must lead from the first to the last number exactly: 1 to 10 in steps of 3 "
     "meets 10, in steps of 4 it does not.",
     "Correct last or step; a blank last means the first number only."},
    {"S210", "a code on a card is unknown",
     "A number that chooses among alternatives (geometry, coordinate system, support, report kind, "
     "method, formulation) is none of them.",
     "Take one of the codes in the message; docs/manual/deck_format.md says what each means."},
    {"S211", "an element type is unknown",
     "The group card asks for an element code that this program does not have.",
     "sagefe list elements shows codes and formulations. Elements of your own come with a program or "
     "plug-in of your own."},
    {"S212", "a material law is unknown",
     "The material card asks for a law code that this program does not have.",
     "sagefe list materials shows codes and parameters."},
    {"S213", "a solver is unknown",
     "The control card or --solver asks for a solver that is not there; some need libraries that this "
     "build lacks.",
     "0 (automatic) always works. sagefe list solvers shows the rest."},
    {"S214", "the deck lacks something that every model needs",
     "There are no nodes, elements, groups or stages: a count on the control card is zero or blank, or "
     "their cards stand under another name.",
     "Give the cards and their counts. sagefe echo DECK shows how each card was taken."},
    {"S215", "the totals do not match",
     "The control card says how many nodes or elements there are, and the cards make another number. The "
     "totals guard against lost cards and wrong generation, so this is not ignored.",
     "Find the card that is missing or generates too much; then correct it, or the total (zero = not "
     "checked)."},
    {"S216", "an element names a node twice",
     "The same node stands at two corners of one element. A quadrilateral of 4 nodes may become a "
     "triangle so; other elements may not, and pairs of interfaces are two nodes at one place.",
     "Correct the node number; for an interface give each side nodes of its own."},
    {"S217", "an element has the wrong number of nodes",
     "The card gives fewer or more nodes than the element type has, or leaves a corner blank. Mid-side "
     "nodes may be left blank all together: they are made.",
     "Give all corners, and all mid-side nodes or none; or choose the element type for that number of "
     "nodes on the group card."},
    {"S218", "a generated line or block does not work out",
     "The numbers of nodes or elements, the steps and the corners of a line or block contradict each other. "
     "The last number is not reached, a corner is not defined before it, two nodes would get one number, or "
     "far too many would be made.",
     "Check columns, rows and steps: node = first + column x column step + row x row step. Corners must "
     "be defined on cards before the block."},
    {"S219", "a step or count was left blank",
     "A blank was taken as 1, or a step without an end was ignored; the message says how the card was "
     "understood.",
     "Nothing, where that is meant; otherwise write the number."},
    {"S220", "a spacing ratio is extreme",
     "The last interval is very many times as long as the first. Elements beside each other then differ "
     "so much in size that accuracy suffers, or the ratio was meant as another quantity (a length).",
     "Ratios between 0.05 and 20 over a whole line are usual. Use more elements instead."},
    {"S221", "a parameter of a law is missing", "The law needs this parameter and has no default for it.",
     "Give it on the parameter card, in the order that sagefe list materials shows, or that the layout "
     "names."},
    {"S222", "a parameter takes its default", "The parameter was left blank and has a default, which is used.",
     "Write the value if the default is not meant."},
    {"S223", "a law has not so many parameters, or none of this name",
     "The card gives more values than the law has parameters, or a program names one that it lacks: the law "
     "is another one than meant, or a parameter was put in twice.",
     "Compare with sagefe list materials."},
    {"S224", "a law or element refuses a parameter",
     "The value is outside of what the law can compute with: a modulus of zero, Poisson's ratio of 0.5, "
     "a friction angle of 90 degrees, dilation above friction. Angles are degrees, stresses the deck's "
     "units.",
     "Correct the value. For nearly incompressible soil take nu up to 0.4999999 with quad4 enhanced "
     "(--formulation 5) or 8-node elements."},
    {"S225", "law and element do not fit",
     "Solids need a law for solids, interfaces a law of joints: the group's material is of the other "
     "kind.",
     "Give the group a material of the right kind; sagefe list materials says for each law what it is "
     "for."},
    {"S226", "the shape of an element can't be used",
     "The element has no area, is folded, runs clockwise, has a corner of 180 degrees or more, lies at "
     "negative radius, or the pairs of an interface are not at one place. Stiffness would be negative or "
     "infinite there.",
     "List the nodes counter-clockwise in the order the message gives, or correct the coordinate that is "
     "off. For an interface, nodes 1-2 run along one side and 3-4 back along the other; in axisymmetry x "
     "is the radius."},
    {"S227", "elements are badly distorted",
     "An element is still computable, but its angles are so far from 90 degrees (60 for triangles), or "
     "its sides so uneven, that stresses in it are of little worth.",
     "Move the nodes, or make the mesh finer where it turns; 8-node elements bear distortion better than "
     "4-node ones. Far from where results are read it does no harm."},
    {"S228", "a title or name is no clean text",
     "It holds bytes that are no UTF-8, or control characters; the outputs show ? for them. Computation "
     "is not touched.",
     "Write the name in ASCII or UTF-8."},
    {"S229", "the deck asks for something that is not computed",
     "The deck has cards for what this program lacks: water, beams or bars, creep, dynamics or parts of "
     "them. The result without them answers another question.",
     "Take these cards out if the question allows it, or give --partial: the rest is computed, and every "
     "result says what is missing."},
    {"S230", "there is no such edge",
     "A pressure card names two nodes, or an element and an edge number, between which no edge of that "
     "solid lies; or the edge lies between two elements and the card does not say which of them is "
     "meant.",
     "Give the two end nodes of one element edge, one edge a card (a longer line needs a card for each), "
     "and the element where two share the edge."},
    {"S231", "an edge is listed the wrong way round",
     "The layout says in which sense edges run around their elements, and this one runs the other way: "
     "pressure would act in the opposite direction.",
     "Exchange the nodes of the card, or give the layout's edge card a field sense (3: either)."},
    {"S232", "the nodes of an edge do not fit its load",
     "A value for a third node is given but no third node, or the middle node is not that of the edge.",
     "Give all three nodes of a quadratic edge in their order, or leave the third value blank."},
    {"S233", "a support card contradicts itself",
     "A displacement is given without code 1 (fixed), or other than zero before the first stage, or a "
     "release (-1) outside of a stage: there is nothing yet to be moved or released.",
     "Put prescribed displacements and releases on the fixity cards of a stage, with code 1 or -1."},
    {"S234", "a support card changes nothing or takes a default",
     "Both codes are 0 or blank, so the card does nothing; or a displacement was left blank, which holds "
     "the node where it is.",
     "Give the code (1 fixed, -1 released), or remove the card."},
    {"S235", "an unknown of a node is not there",
     "The card names a field such as rotation or pore pressure that no element at this node solves for, "
     "or gives it two components where it has one.",
     "Take the field's name from the message, or give the node an element that solves for it."},
    {"S236", "an initial stress or history card does not fit",
     "The kind of the card is not for this group (1 geostatic: solids; 3 traction of the neighbours: "
     "interfaces), a quantity stands twice or does not exist, or the law can't start from what is "
     "stated.",
     "Choose the kind for the group and the values in their order: docs/manual/deck_format.md, card "
     "initial. sagefe list materials counts the history of each law."},
    {"S237", "values of an initial stress card are blank or not used",
     "Blank components read as 0, and values the kind has no use for are ignored. Both often come from "
     "another kind of card having been in mind.",
     "Compare with docs/manual/deck_format.md, card initial; write the zeros that are meant."},
    {"S238", "a number of the stage card is out of range",
     "Increments, duration or tolerance of the stage can't be as given: at least 1 increment, a "
     "tolerance between 0 and 1 (1e-8 where blank), no negative time.",
     "Correct the field."},
    {"S239", "births and deaths contradict each other",
     "A group is activated twice, or removed before it is activated or in the same stage; or an element is "
     "removed twice. A group that was removed can't come back: its history is gone.",
     "Correct the stages. To place a body again, use another group with the same nodes and a material of its "
     "own."},
    {"S240", "increments and what they drive do not fit",
     "Load factors stand without a load, displacements without a displacement card, or both kinds on one "
     "card.",
     "Give each increments card one kind of numbers, and the card that says what they multiply."},
    {"S241", "strength factors can't be used as given",
     "Factors on strength need a deck with one step of loading, no start stress, and a material with a "
     "strength; each must lie above 0.",
     "Correct the factor, or reduce the strength on the material card and run the deck twice. sagefe "
     "safety searches for the factor of any deck."},
    {"S242", "a report card lacks something",
     "A report needs what its kind measures: a height for a triaxial specimen, a point card for a point, "
     "a stage that exists, an area where it can't be found from the nodes.",
     "Complete the card: docs/manual/deck_format.md, cards report and point."},
    {"S243", "a point lies outside the mesh",
     "No solid element of the mesh, or of the group asked for, holds the point. Units (mm for m) and "
     "exchanged coordinates are the usual reasons.",
     "Correct the coordinates or the group; a point on the edge of the mesh counts as inside."},
    {"S244", "a node on the axis can't be moved radially",
     "At r = 0 the radial displacement is zero by symmetry. A value, or a release, would tear a hole "
     "into the body.",
     "Remove the radial code of that node, or check whether the model is meant to be in plane strain "
     "(geometry 1)."},
    {"S245", "the start stress can't be computed",
     "The start stress from the weight of the ground needs horizontal layers of one unit weight each, K0 "
     "of every material, a level not below the ground, and no interfaces in it: only then is it in "
     "equilibrium by itself.",
     "Give what is missing. On other ground use a first stage with a gravity card, or initial cards by "
     "group (kind 1 for ground, kind 3 for interfaces)."},
    {"S246", "the start stress and equilibrium",
     "The state at the start holds only with forces that the deck does not state: pressures at free "
     "edges, or K0 that differs along one level. The message names what was added, or what will move in the "
     "first increment.",
     "Where K0 differs, give one value a level, or let a gravity stage find the stresses."},
    {"S247", "p_a or gamma_w is missing",
     "The law uses the atmospheric pressure or the unit weight of water of the deck's unit system, which "
     "has no built-in units.",
     "Give it on the control or unit card: p_a is 101.325 kPa or 14.696 psi, gamma_w 9.81 kN/m3 or "
     "0.036111 pci."},
    {"S248", "a water card does not fit",
     "The card lacks what its kind needs (points of a line, pairs of node and pressure, r_u, a bulk of water), "
     "or has numbers where its kind reads none. Or it names a stage that does not exist or a group that is no "
     "solid, or needs heads where none are solved for.",
     "Complete the card: docs/manual/deck_format.md, card water; docs/manual/water.md."},
    {"S249", "undrained, and a pressure is given",
     "The pore pressure of an undrained group follows from its change of volume. A card that changes it in the "
     "same stage contradicts that.",
     "Give the pressure in an earlier stage, or make the group drained (kind 6) first."},
    {"S250", "heads of an earlier run can't be used",
     "A water card of kind 7 takes heads from the result file of another run. The file is missing or none of "
     "this "
     "program, its run solves for no heads, ended without equilibrium or lacks the stage, its lengths or "
     "geometry are "
     "others, or nodes of this deck lie outside its mesh.",
     "Run the deck of the flow with --result, name its STEM.h5 as seen from this deck's folder, and let its "
     "mesh hold "
     "all solids that the card is about."},
    {"S251", "a mesh lies in another plane",
     "A model in two dimensions lies in the plane of x and y. The nodes of this mesh have several heights z: "
     "it "
     "was drawn in the x-z or y-z plane, or is a surface in space.",
     "Draw the geometry with one z and y upwards, or turn it in the program that made the mesh (Gmsh: "
     "Rotate)."},
    {"S252", "a surface belongs to two groups",
     "Each surface of a mesh becomes part of one element group with one material, and this one has two names.",
     "Give the surface one physical group, or in an .inp file name the sets of the groups by *SOLID SECTION. "
     "Curves may belong to several."},
    {"S253", "an element can't take the place of the deck's",
     "--element and --element-b replace quadrilaterals by others with as many nodes or more: the middle nodes "
     "that the cards lack are made. Nodes that the cards give are never dropped, and triangles stay.",
     "Choose an element with enough nodes (sagefe list elements), or write the deck with 4-node "
     "quadrilaterals."},
    {"S254", "the data of a section are incomplete",
     "A point, line or area of a drawn section lacks something. An index names no point or line, a line has "
     "too few points, the ends of an arc are not equally far from its centre, or a size is negative.",
     "Complete or correct the item that the message names."},
    {"S255", "an outline encloses no area",
     "The outline of an area or of its hole crosses or touches itself, encloses nothing, or the hole reaches "
     "outside of the outline. Inside and outside can't be told apart then.",
     "List the corners in their order around the area. Divide an area that touches itself into two."},
    {"S256", "areas of a section overlap",
     "Two areas contain the same ground. Each place belongs to one area with one material.",
     "Let the areas share an edge, or give the larger one a hole that the smaller one fills."},
    {"S257", "a line of a section lies outside of all areas",
     "A line without a beam needs an area on one side at least, and a joint needs areas on both sides. A line "
     "with a beam may stick out of the ground, but must touch it.",
     "Correct the line's points, or the outline of the area that should reach there."},
    {"S258", "two lines with structures lie on each other",
     "A piece of a section's outline or ground can carry one beam, and one row of interface elements on each "
     "side of it. Here two lines ask for it.",
     "Let one of the lines end where the other begins, or remove the beam or the interfaces of one."},
    {"S259", "this section needs Gmsh",
     "Gmsh makes meshes of general areas and can't be loaded. Without it the program meshes areas of four "
     "sides whose opposite sides have as many pieces, and sections in which all lines are horizontal or "
     "vertical.",
     "Install Gmsh's library (Debian: libgmsh4.8), name its file in SAGEFE_GMSH, or divide the area into "
     "blocks."},
    {"S260", "there is nothing to divide for a safety factor",
     "sagefe safety divides the strengths of the chosen groups. The deck has no such stage or group, or no "
     "chosen group has a law whose entry names a strength. Elastic laws have none; joints, anchors and walls "
     "are divided where --reduce names them only. A law of your own names its strengths by the roles of its "
     "parameters.",
     "Correct --stage or --group, name more parts in --reduce, or give the soil a law with strength "
     "(sagefe list materials)."},
    {"S261", "Gmsh can't mesh an area",
     "Gmsh reported an error, left a part of the area empty, or put elements across a line. Lines that almost "
     "touch, or that meet at a very small angle, are the usual cause.",
     "Let lines that almost meet share a point, or choose smaller sizes around them."},
    {"S262", "the sizes ask for too many elements",
     "The number of elements that a size asks for grows with its inverse square. Sizes are lengths of edges, "
     "in "
     "the unit of length of the coordinates.",
     "Choose larger sizes, or small ones only at the points and lines that need them."},
    {"S263", "an element of a meshed section is turned inside out",
     "Arcs become straight edges with nodes on the arc. Where another line passes closer than the arc bulges, "
     "an "
     "element between them has no area left.",
     "Choose smaller sizes along the arc, or move the other line."},

    // S3: a legal model that may not be meant.
    {"S301", "p_a or gamma_w does not fit the units",
     "In the units the deck names, the atmospheric pressure or the unit weight of water has another "
     "value. All moduli of hyperbolic laws, and the stiffness of joints, scale with it.",
     "Correct the value, or the names of the units."},
    {"S302", "the units do not belong together",
     "One unit of stress is not one unit of force over a unit of length squared, as with kN, mm and kPa. "
     "Loads, weights and moduli then disagree by powers of ten.",
     "Use a consistent set: kN, m, kPa; N, mm, MPa; lbf, in, psi; kip, ft, ksf."},
    {"S303", "an initial stress is implausible",
     "K0 outside 0.3 to 3, tension, a ground level far from the mesh, a negative weight, or a stress "
     "above the material's modulus. Initial stresses are compression positive.",
     "Check sign, unit and level. Tension at rest is wrong for most soils."},
    {"S304", "elements are needles",
     "Elements are more than 10000 times as long as wide: most often a coordinate with a lost decimal "
     "point, or a layer meant to be an interface.",
     "Correct the coordinate; model thin zones by interface elements of zero thickness."},
    {"S305", "element numbers have a gap",
     "Numbers jump: a block may be shorter than meant, and a part of the body be missing.",
     "Look at the mesh (sagefe run DECK --picture displacement draws it). Nothing is to be done where the gap "
     "is "
     "meant."},
    {"S306", "a material parameter is implausible",
     "A negative Poisson's ratio or unit weight, a strength above the modulus, or a friction angle that "
     "looks like radians. The law can compute with it; soil is seldom like it.",
     "Check unit and column. Angles are degrees."},
    {"S307", "a displacement is larger than the mesh",
     "Strains are taken as small; a displacement of the size of the body is a slip in its unit (mm for "
     "m), or can't be described.",
     "Correct the value, or the unit of the coordinates."},
    {"S308", "a load is implausibly large",
     "The force or pressure would strain the whole mesh by more than 1, or exceeds the largest modulus.",
     "Check the unit of loads and moduli. In axisymmetry nodal forces are for the full circle."},
    {"S309", "a release where nothing holds",
     "Code -1 takes away a support, and this node had none in this direction.",
     "Correct node or direction, or remove the card."},
    {"S310", "a pressure acts in an unusual way",
     "It pulls, acts on an edge inside the body that two elements share, or on one side of an interface "
     "only. All are possible and seldom meant.",
     "Check sign and nodes: positive pressure pushes into the element. Pressure belongs on the surface "
     "as it is in that stage."},
    {"S311", "gravity acts in an unusual way",
     "Gravity is a factor on unit weights, added to what earlier stages have; -1 in y is the usual one, "
     "once. Factors above 3 (9.81 is the acceleration in m/s^2), an upward or radial direction, or a second "
     "one are reported. Models of a centrifuge, up to about 3 m high, may have 15 to 500.",
     "Give gravity_y = -1 in one stage. A stage that shall leave gravity as it is has 0."},
    {"S312", "gravity and unit weights do not go together",
     "Gravity acts, but no material has a unit weight, one is blank, or the weight of a column as high "
     "as the mesh exceeds the modulus.",
     "Give unit weights in the deck's force per cubed length (18 kN/m3, 0.065 pci); 0 where a body is "
     "meant to be weightless."},
    {"S313", "a stage has very many increments",
     "Each increment is a solution of its own; the run takes as many times as long as one.",
     "Fewer increments mostly give the same: compare with half as many. For elastic bodies one is "
     "enough."},
    {"S314", "the tolerance is loose",
     "So large a part of the forces may stay out of balance that what the stage calls equilibrium may be "
     "none; reports and limit loads are off by about as much.",
     "Take 1e-8 (blank) to 1e-4."},
    {"S315", "an initial stress is replaced",
     "Two initial cards are for one group in one stage. The later card stands.", "Remove one of them."},
    {"S316", "a stage adds nothing",
     "The stage has no load, displacement, gravity, activation or removal. It only releases unbalanced forces. "
     "That is right behind an initial stress, and else often a card that ended up in another stage.",
     "Check the order of the cards, or remove the stage."},
    {"S317", "a report's numbers do not fit the mesh",
     "The height, area or cell pressure on the report card is far from the mesh or the moduli. Strain is "
     "displacement over this height, stress is force over this area.",
     "Give the height and area that were modelled (of the whole specimen, where a quarter of it is "
     "meshed: see docs/manual/deck_format.md)."},
    {"S318", "a point lies on a border, or in nothing active",
     "Where bodies meet, stresses jump and one group has to answer; or no element that holds the point "
     "is active when the report starts.",
     "Give the point's group, or move it off the border. Check which groups the stages activate and remove."},
    {"S319", "a straight side is held in part",
     "Most nodes of a side are held along one direction and some are free: a forgotten node on a line of "
     "symmetry, or the last number of a range.",
     "Hold all nodes of a line of symmetry. Where the free ones are meant (a footing, a platen), nothing "
     "is to be done."},
    {"S320", "two cards of a stage contradict each other",
     "A node is given two displacements, or is held and released, in one stage. The last card stands; "
     "corners that belong to two lines are the usual place.",
     "Keep one card for the node, or give the last the value that is meant."},
    {"S321", "a load on the axis has no effect",
     "At r = 0 a radial force acts on nothing, and an edge there has no area.",
     "Remove the load, or check whether plane strain (geometry 1) is meant."},
    {"S322", "no element takes part in a stage",
     "Every group is removed or not born yet, so there is nothing to be in equilibrium.",
     "Correct which groups this stage or one before it activates and removes."},
    {"S323", "nothing holds the mesh",
     "A part of the body can move without straining: as a whole along x or y, or turn. The stiffness "
     "matrix is singular then. Parts that touch without common nodes or an interface are separate.",
     "Add fixities, at least two in one direction and one in the other (one along the axis in "
     "axisymmetry); join parts by common nodes or interfaces."},
    {"S324", "the solver is for symmetric matrices only",
     "Plastic flow that is not associated (dilation other than friction), and interfaces with friction, "
     "have an unsymmetric tangent. A symmetric solver would converge badly or not at all.",
     "Solver 0 (automatic), or an unsymmetric one of sagefe list solvers."},
    {"S325", "elements lock near nu = 1/2",
     "Fully integrated 4-node elements of nearly incompressible material are too stiff, and stresses "
     "oscillate from element to element; the source chapter's nu = .495 entries are 3 to 4 percent off "
     "by it.",
     "--formulation 5 (enhanced) or 8-node elements (--element quad8). Compare both: sagefe compare DECK "
     "--formulation-b 5."},
    {"S326", "elements overlap",
     "Two elements cover the same ground: its stiffness and weight count twice. A block is there twice, a node "
     "lies beyond its neighbour, or a group that a later stage activates on the same nodes is not declared.",
     "Correct nodes or blocks. A group that lies on others on purpose (a reinforced zone, a body that comes "
     "back) needs overlay 1."},
    {"S327", "an interface does not lie between its bodies",
     "The sides of an interface element belong to the wrong bodies, or its nodes are not those of the "
     "solids beside it: normal stress would come with the wrong sign.",
     "List nodes 1-2 along the side of the first body and 3-4 back along the other, each side with nodes "
     "of its own solid."},
    {"S328", "nodes on the axis are held",
     "In axisymmetry the radial displacement at r = 0 is zero; these nodes had no support and were given "
     "one.",
     "Nothing is to be done. In plane strain (geometry 1) it does not happen."},
    {"S329", "something is not used",
     "Nodes belong to no element, or no group has this material. They are left out of the computation.",
     "Nothing, or remove the cards. Many unused nodes mean that a block of elements is missing."},
    {"S330", "a node without elements is loaded or displaced",
     "The node belongs to no element (in any stage), so a load or displacement there reaches nothing.",
     "Correct the node number; mid-side nodes that are made get numbers behind those of the deck."},
    {"S331", "a law warns of its parameters",
     "The law can compute with these parameters, and says in which range they mislead.",
     "Read the law's page in docs/theory; the message names parameter and range."},
    {"S332", "a card does nothing in its stage",
     "What it names is not active then: the elements are removed or not yet born, or the nodes belong to "
     "none that is, or have no such unknown (a support of displacements where only water flows).",
     "Move the card to the right stage, correct which groups are active, or give the unknown's name (head)."},
    {"S334", "the mesh is coarse for what is asked",
     "Between two loads or supports lie so few elements that the answer there is far from that of a fine "
     "mesh. The message says by about how much.",
     "--refine 1 and compare, or --error and --converge: docs/manual/accuracy.md."},
    {"S335", "interfaces touch no solid",
     "An interface element has a solid on neither side, so that it can't be checked which side is which.",
     "Nothing, where its nodes are held by fixities on purpose; otherwise correct its nodes."},
    {"S336", "bodies meet without being joined",
     "Two nodes lie at one place and belong to separate bodies with no interface between them: the "
     "bodies can pass through each other.",
     "Use one node for both, or put an interface element between them. Separate bodies on purpose (a "
     "gap) can stay."},
    {"S337", "a node hangs on a neighbour's side",
     "A node of one element lies on the edge of another that does not have it: the mesh gapes or "
     "overlaps there once it deforms.",
     "Refine so that edges meet whole, or use elements with mid-side nodes where the hanging node lies "
     "in the middle."},
    {"S338", "nodes hang on a joint alone",
     "In this stage no solid is active on one side of the joint: its nodes are held only by the joint's "
     "own stiffness, and by nothing once it opens.",
     "Place and remove a joint together with its solid, or hold the nodes by fixities."},

    // S4: refining, grading and mid-side nodes.
    {"S339", "water above a free edge that no load balances",
     "The phreatic line lies above edges that nothing supports, and its card says that no water stands there "
     "(action 1): the soil is pressed outwards by its own water.",
     "Action 0 lets the water stand at the edges; or lower the line, as where the soil is covered."},
    {"S340", "pore pressure lifts what lies above",
     "The pore pressure is more than the weight of soil and water above: the vertical effective stress is "
     "negative, as in the floor of an excavation over an artesian layer.",
     "Lower the pressure (dewatering), leave more ground, or check the level of water and the unit weights."},
    {"S341", "open water beside a wall that has none on it",
     "Water stands on the ground in front of a wall or beside a slab, and on the beams themselves there is "
     "none: "
     "they would bear the water behind them without what stands in front.",
     "A water card of kind 1 that names the group of the beams, with the side in value 1: "
     "docs/manual/water.md. "
     "Nothing, where the wall is meant to keep its water in and a pressure card or nothing stands there on "
     "purpose."},
    {"S345", "a structure is held by joints alone",
     "A wall, raft or lining shares no node with solids, no support holds it, and its joints carry no "
     "tension: what holds it is pressure and friction. Where joints lie on one side only it can lift off.",
     "Nothing, where weight or pressure is there from the first increment on. Else hold a node (a wall's toe), "
     "give the joint tension, or let the structure share nodes with the soil."},
    {"S346", "a beam turns freely",
     "The beam meets the rest of the model in a single node, and neither a support nor another beam holds its "
     "rotation there: solids and bars hold displacements alone. The stiffness matrix is singular then.",
     "Hold the rotation of that node by a fixity card with the unknown's name, let the beam go on into the "
     "solid along a side, or use a bar."},
    {"S347", "released ends meet at a node",
     "A beam whose end is released along its line (or across it) has one more unknown at that node, along its "
     "own line. Two such beams would share it.",
     "List the nodes of one of them the other way round, so that its released end is at its other node."},
    {"S348", "a joint that slips follows a polygon",
     "Interfaces of two pairs of nodes stand for a curve, as around a pipe. A node that slides along one chord "
     "opens or closes the next, so that the smooth pipe is held as if it were bonded: thrust and moment are "
     "those of the bonded one.",
     "interface6 with quad8 and beam3 and the nodes in the middle on the curve (docs/manual/structures.md); or "
     "nothing, where the joint does not slip under the loads of the deck."},
    {"S349", "a joint beside undrained soil bears its water",
     "A joint's traction is effective where the pore pressure is given. The excess pressure of an undrained "
     "group "
     "follows from its change of volume and is not taken off: the traction there is the total one, and "
     "friction "
     "counts water as grains.",
     "A joint with friction 0 and the undrained adhesion as cohesion; or nothing, where the joint is elastic."},
    {"S350", "the weight of a plate is its unit weight times its thickness",
     "Of the law plate the unit weight is a force per volume, as for soil: 25 kN/m^3 and 0.5 m weigh 12.5 "
     "kN/m^2. "
     "Earlier versions took the unit weight itself as the weight of a unit of area.",
     "Nothing, where the card gives a force per volume. In a deck of an earlier version, divide the number by "
     "the "
     "thickness. Sections state a weight per length and width, bars that of one bar per length "
     "(docs/manual/structures.md)."},
    {"S351", "prestress that a structure can't carry",
     "The initial card gives a force that the law of the bars or beams does not allow: compression in an "
     "anchor that "
     "carries tension alone, tension in a strut that carries compression alone, or more than the strength.",
     "Initial values are compression positive and count for each unit of width: -150/2.5 for anchors that are "
     "pulled "
     "with 150 every 2.5. Change the sign, the size or the law."},
    {"S352", "strips meet on the axis of symmetry",
     "A beam without hoop bending stiffness is one of many strips side by side. Where they meet on the axis "
     "their width is nothing: "
     "with the rotation held there, as symmetry wants it, the moment grows as 1/r, and its value at the axis "
     "is set by the size of "
     "the elements.",
     "Give a plate its thickness (law plate), or a section its hoop stiffnesses. Spokes that end on a hub are "
     "held at its radius."},
    {"S355", "4-node elements dilate",
     "A group of 4-node quadrilaterals without an enhanced strain has a law whose plastic flow increases the "
     "volume. These elements "
     "cannot follow that flow and resist too long. On a slope of 1:2 with phi = psi = 20 degrees the factor of "
     "safety is 1.52 with b-bar and 1.58 with full integration. 8-node elements give 1.39, and 1.36 to 1.37 is "
     "right. With psi = 5 degrees the error is the same. docs/theory/accuracy.md has the measurement.",
     "Use quad4 enhanced (--formulation 5) or 8-node elements (--element quad8). With a dilation angle of 0 "
     "(sagefe "
     "safety --dilation none) b-bar elements are about 3 % high."},
    {"S356", "a unit weight is not one of soil",
     "In the deck's units the number is less than a quarter or more than 3.5 times the unit weight of water "
     "(8.5 times for a law without strength, which may be steel). Likely it is a density (kg/m^3, t/m^3), or "
     "in "
     "the unit of another program.",
     "Give the unit weight in the deck's force per cubed length: 18 to 21 kN/m^3, 115 to 130 lb/ft^3 or 0.066 "
     "to 0.075 lb/in^3. Correct the units card where that is wrong."},
    {"S358", "a modulus or cohesion is not one of soil",
     "As a multiple of the atmosphere in the deck's units the number is far from what soils have. These are a "
     "modulus below 0.5 or, for a law with strength, above 100000 times; a cohesion above 10 times, or without "
     "friction below 0.005 times. Likely it is in another unit (Pa, MPa).",
     "Give moduli and strengths in the stress unit of the units card. A warning for rock, concrete or a peat "
     "is "
     "no mistake of the deck."},
    {"S360", "water levels differ between neighbours",
     "Two groups that share edges have different phreatic lines (or one is dry, or has r_u or pressures of "
     "nodes), and no structure or joint "
     "lies "
     "between them. The pore pressure jumps there, and the difference acts as a force that no ground water "
     "has.",
     "Give both groups one line that falls from level to level, put the wall or joint between them that holds "
     "the water back, or compute the heads by elements of flow."},
    {"S361", "what pore water does in a stage is unknown, or no element has any",
     "The field pore_water of a stage card is 0 (excess pressures stay as they are), 1 (undrained: no water "
     "moves) or 2 "
     "(consolidation). Codes 1 and 2 need elements that solve for the pressure of pore water.",
     "Correct the code, or use quad8p4, quad9p4 or tri6p3 with a second material pore_flow "
     "(docs/manual/consolidation.md)."},
    {"S362", "the division of a stage's time is out of range",
     "theta lies between 0.5 (Crank-Nicolson) and 1 (backward Euler). The ratio of an increment to the one "
     "before lies "
     "between 0.01 and 100.",
     "Correct the field; blank is 1."},
    {"S363", "the first step of a consolidation stage is short",
     "A step below h^2 / (6 theta c) gives excess pressures that oscillate from node to node beside a drained "
     "node "
     "where a pressure starts to fall. h is the size of quadratic elements there, c their coefficient of "
     "consolidation. "
     "They are those of the discrete equations, and die out.",
     "Make the mesh finer at the drained node, or the first step longer; a grading above 1 serves the later "
     "ones."},
    {"S364", "excess pressures oscillate",
     "A corner has a higher excess pressure than all corners around it, and one of those a lower one than all "
     "around it, "
     "by more than 1 % of the largest. Pressures of the soil have no such waves.",
     "Make the mesh finer at drained nodes, or the first steps longer; theta = 1 damps what theta = 0.5 "
     "keeps."},
    {"S365", "water can't leave",
     "No excess pressure is held in a part of the model, so that all water stays within it: the pressures even "
     "out and "
     "do not go to zero.",
     "Hold the excess pressure (unknown excess_pressure, code 1) where water may leave, if that is meant."},
    {"S366", "a group has its pore water twice",
     "A water card makes a group undrained (or drained) whose elements solve for the pressure of their water.",
     "Leave the card away: stages say whether that water is shut in (field pore_water)."},
    {"S401", "elements of different degree meet",
     "One element has nodes inside the common edge, the other has not: the mesh would gape there.",
     "Give both the same number of nodes an edge; --element quad8 turns all of the mesh."},
    {"S402", "the mesh can't be refined as asked",
     "It would have more elements than can be numbered, or its elements have nodes of their own inside "
     "that a division has no place for.",
     "A smaller --refine, --grade at corners, or elements of higher degree: docs/manual/accuracy.md."},
    {"S403", "the mesh can't be graded there",
     "The node of --grade is no corner of an element, does not exist, or (auto) no corner with a "
     "singular stress was found.",
     "Name a corner node of an element, or --refine without --grade."},
    {"S404", "a support or load can't follow the graded mesh",
     "It belongs to a node that the graded mesh no longer has; grading moves what lies between corners.",
     "--refine, which keeps all nodes, or load the edge by a pressure card."},
    {"S405", "a report loses nodes by grading",
     "Some of its nodes are no nodes of the graded mesh; the mean is taken of those left.",
     "--refine keeps all of them. Where the platen is rigid the mean is the same."},
    {"S406", "an answer that does not converge with the mesh",
     "A load on one node, and the stress at a singular corner, grow without limit as elements get "
     "smaller: that number has no true value to come near to.",
     "Use a pressure over a width; read stresses a little away from the corner, or sums such as a "
     "platen's force."},
    {"S407", "the mesh stays as it is",
     "No coarser mesh of quadrilaterals has the same bodies, supports and loads.",
     "Nothing: the run uses the deck's own mesh."},
    {"S408", "the wanted certainty was not reached",
     "--converge made meshes up to its limit of unknowns or of time, and the reports still change by "
     "more than the tolerance. Singular corners, a limit load or a point load make numbers converge "
     "slowly or not at all.",
     "Read the last column: it says how certain each number is. --max-dofs or --max-seconds further, "
     "--grade auto, elements of higher degree, or --follow with a number that does converge."},
    {"S409", "refining makes a large model",
     "Each --refine makes four elements of one; memory and time grow at least as fast. The message "
     "estimates the memory.",
     "--grade at corners, or 8-node elements, give the same accuracy with far fewer elements."},
    {"S410", "the error of the mesh is not estimated",
     "Elements of the model lock near Poisson's ratio 1/2, or where soil is undrained. Their stresses are "
     "smooth and "
     "wrong, and the estimate of --error sees only what is not smooth.",
     "Elements that do not lock: 8-node quadrilaterals (reduced), quad4 enhanced, or those of high degree."},

    // S5: the analysis.
    {"S501", "no equilibrium",
     "The increment found no state in which stresses balance the loads, however small it was made. "
     "Mostly a limit load was reached: more can't be carried by the strength there is. Else the "
     "increments are too large for a law that changes much, or joints open and close to and fro.",
     "The message says up to which load equilibrium held, where it failed and what to try. At a limit "
     "load that is the answer; drive the body by displacements to go on. Otherwise more increments, or "
     "method 3 (dogleg)."},
    {"S502", "the stiffness matrix is singular",
     "A motion costs no force: a body is not held, hangs on joints that are open, has no stiffness left "
     "at collapse, or its stiffnesses differ by more than 16 digits. The message names node and "
     "direction.",
     "Add supports or interfaces for that part, make very stiff bodies less stiff, or end the loading "
     "before."},
    {"S503", "a law can't start from its initial stress",
     "The law needs another state at the start: a hyperbolic law compression, a law with strength a "
     "stress that it can carry.",
     "Give an initial card with a small confining stress, or a cohesion. sagefe drive and docs/theory "
     "show each law's range."},
    {"S504", "the solver lost its digits or gave up",
     "Growth of numbers, or terms that are no numbers, spoilt the factorisation. Stiffnesses that differ "
     "by 1e12 and more, or a collapse, are the usual reasons.",
     "Another solver (--solver, sagefe list solvers), or stiff parts only 1e3 to 1e6 times as stiff as "
     "the soil; interface stiffnesses likewise."},
    {"S505", "a part of the program can't be loaded",
     "The library solvers and the writer of result files are modules beside the program; one is not "
     "installed, or its libraries are missing.",
     "Install the program whole (cmake --install), or the packages that the message names. Built-in "
     "solvers work without them."},
    {"S506", "kernels or threads can't be had",
     "--kernels asks for instructions that this machine or build lacks.",
     "Leave out --kernels: the fastest that work are taken."},
    {"S507", "a result is no number",
     "An undefined or infinite number would have been written: the model's numbers are so large or small "
     "that they overflow.",
     "Use units in which stresses and lengths are between 1e-6 and 1e6."},
    {"S508", "there is not enough memory", "The model does not fit into this machine's memory.",
     "Fewer elements (--grade in place of --refine), another solver (multifrontal needs less than the "
     "profile solver on large meshes), or a larger machine."},
    {"S510", "a piece of the analysis gave up",
     "A solver, law or element, perhaps one from outside of this program, says that it can't go on.",
     "Its own message says why; try --solver with another one to see whether the solver is the reason."},
    {"S511", "the run was interrupted",
     "Ctrl-C, or a request of the system to end, stopped the run. What was complete is on disk; a "
     "checkpoint was written where one could be.",
     "sagefe run --restart goes on from the checkpoint; decks that were not begun have to be named "
     "again."},
    {"S512", "the process of a deck was ended",
     "With --jobs each deck has a process of its own, and this one was killed: by the system for want of "
     "memory, by a user, or by a fault of the program.",
     "Run the deck alone to see whether it ends again; fewer --jobs need less memory at a time. A fault "
     "of the program is worth a report with the deck."},
    {"S513", "a fault of the program or of a library",
     "Something happened that the program does not foresee: the message is that of a library or of a check "
     "within the program. The deck may be right.",
     "Try another solver (--solver) and one thread (--threads 1), to see what it depends on. A report with the "
     "deck, the command and the message helps to mend it."},
    {"S515", "the safety factor is not proved",
     "The search for the factor ended without the bracket that was requested. No factor is stable, every "
     "factor is stable, or the upper end proves nothing: no equilibrium was found, but the ground does not go "
     "on moving. There the iterations may have failed and not the soil.",
     "Read the reasons of both ends. Move --smallest or --largest; for an end that is not proved more "
     "--iterations and --cuts, --from anew, or --dilation reduced with a dilation angle nearer to friction."},
    {"S520", "the initial stress is outside the yield surface",
     "At some points the stated stress is more than the strength allows. The first increment sheds it to "
     "the neighbours: the state the run starts from is another one than stated.",
     "Lower the initial shear (K0 nearer to 1), raise the strength, or accept it: the listing shows the "
     "stresses after the first increment."},
    {"S521", "displacements are beyond small strains",
     "The program takes strains as small and the geometry as it was at the start. Displacements of this "
     "size change the geometry: the numbers describe something else.",
     "Read results up to a displacement of about a tenth of the body; smaller loads."},
    {"S522", "points are at the apex or cut off in tension",
     "There the law has little shear strength left or none, and the stress depends on how tension is treated "
     "(to the "
     "apex, cut off, stress free). The message counts them apart, with points of any status whose tangent in "
     "the last "
     "iteration has no stiffness in any direction. Several states may be in equilibrium there.",
     "Look where they are (--points). At a free surface they mostly do no harm; compare with another "
     "tension limit or apex code."},
    {"S523", "the answer may not be the only one",
     "The acoustic tensor has lost its positive determinant at yielding points: shear bands may form, whose "
     "width is that of an element. Where the strength falls with strain (a law that softens), peak loads and "
     "what comes behind them depend on mesh and steps: a warning. Where it does not, flow is merely not "
     "associated (dilation below friction), which most sands are: a note, in the listing and with -v.",
     "Compare two meshes (--refine 1) and twice the increments. Dilation equal to friction bounds the "
     "load from above."},
    {"S524", "the sums of forces are out of balance",
     "Loads and reactions of the whole model differ by more than rounding: digits were lost in the "
     "solution.",
     "Look at S525 and S504: stiffness ratios, nu near 1/2. Another solver can tell."},
    {"S525", "digits are lost",
     "So stiff parts stand beside so soft ones, or nu is so near to 1/2, that of 16 digits only a few "
     "are left; the message says how many.",
     "Less stiff stiff parts (1e3 to 1e6 times), nu of 0.499 with B-bar. Where four digits are enough "
     "nothing is to be done."},
    {"S526", "increments are too long for the law",
     "The stiffness of a law (hyperbolic, Cam clay) changes within an increment; even divided into 64 parts it "
     "is "
     "too long to follow, and twice the increments would give something else by more than 1 percent.",
     "More increments in this stage: compare with twice as many until nothing changes."},
    {"S527", "a part hangs on open interfaces",
     "All interfaces around the part are open: nothing but a remnant of stiffness says where it stands. "
     "Its displacements mean nothing from then on.",
     "Hold the part by fixities, or read the run up to here: that is where the joint opened."},
    {"S528", "the first stage starts out of balance",
     "The initial stresses are not in equilibrium with weights, loads and supports of the first stage, "
     "and the first increment lets the difference go: bodies move before anything is loaded.",
     "Where the motion matters, correct initial stress, K0 or weights, or add the gravity or pressure "
     "that belongs to the stress. For a start with no stress at all nothing is to be done."},
    {"S529", "exits of water are switched to and fro",
     "At an exit either the head stands at its limit and water leaves, or it stands lower and nothing flows. "
     "At the nodes that the message names one leads to the other again and again, so that no answer was found.",
     "Smaller elements near the end of the wet face, or fewer exits, where it is known that they stay dry."},

    {"S530", "the correct response of a triaxial report is not known",
     "The report drives one point of the specimen's law along the strains of the mesh. From the increment that "
     "the "
     "message names on no state of that point was found, so that correct values and ratio are blank. The "
     "message says "
     "why: mostly a strength that falls more steeply than the point unloads, or a cell pressure beyond the "
     "strength.",
     "More increments; for laws that soften a lower rate of softening. Measured values do not depend on it."},
    {"S531", "the correct test of a triaxial report starts elsewhere than the mesh",
     "The correct test is that of one point, which starts from the stress and the history of the specimen. "
     "Here the "
     "specimen is not uniform at the start of the report's stage.",
     "Begin the report in the stage in which the specimen is still uniform, or read the ratio with that in "
     "mind."},

    {"S537", "a free surface is blurred",
     "Soil of law darcy_free_surface falls dry within a ramp of the pressure head, as high as an element where "
     "the "
     "deck does not say. That is much of what is wet here: the surface is where the ramp is, and the discharge "
     "is in "
     "error by about its height.",
     "Smaller elements (--refine 1), or a smaller ramp in the material. Compare the discharge of both."},
    {"S538", "dry soil carries water",
     "Above the free surface the soil keeps a part of its permeability, so that heads are determined there. "
     "Here what "
     "flows there is no small part of the whole: thin wet soil under much dry soil, or a part that is too "
     "large.",
     "A smaller 'least' in the material (1e-4), or leave the soil out that stays dry."},
    {"S539", "no free surface was found",
     "The free surface is looked for with soil that falls dry over a great height at first, then over less and "
     "less "
     "down to what is meant. At some height no heads were found from those before.",
     "A larger ramp or a larger 'least' in the material, smaller elements, more iterations in the stage. Look "
     "whether "
     "the soil may let water out where it must (exits, code 2)."},
    {"S540", "the flow has no stream function",
     "What flows between two places is one number only where nothing comes in or goes out inside the flow. "
     "Around a well, a drain or a held head inside, and around a hole whose edge takes water, each turn adds "
     "what is taken. "
     "The field is left blank in that part of the flow.",
     "Take discharge through lines of nodes (report 4), or --picture flow_net, whose lines jump along a line."},

    {"S541", "the rule of a sloping phreatic line",
     "The pore pressure at a depth below a phreatic line is hydrostatic only where the line is level. In "
     "seepage "
     "along a slope, whose lines of equal head stand at right angles to it, it is cos^2 of the slope times "
     "that: 12 % "
     "less at 20 degrees. The note says which of the two the deck has.",
     "Value 1 of the water card: 0 counts the vertical depth (the safe side below a slope), 1 multiplies it by "
     "cos^2 "
     "of the line's slope. Flow elements (kind 4) solve for the pressure instead."},
    {"S542", "an exit gradient without bound",
     "Where an impervious edge meets one with given heads at more than a right angle, or the edge of the flow "
     "turns "
     "inwards, the velocity has no bound: the gradient that is computed there grows with every refinement. "
     "Reports of "
     "lines through such a node leave the largest gradient blank.",
     "End the line before that node, and judge the exit by the mean gradient over a length that matters "
     "(Terzaghi: half "
     "of the embedment), or by the force on it."},

    {"S550", "steps were found by dynamic relaxation",
     "Where the shortest step of Newton's method finds no equilibrium, the supports move on by a small elastic "
     "step, and the ground moves until it comes to rest. The rest is an equilibrium to the tolerance of the "
     "stage, "
     "with the history of that motion. Where flow is not associated there may be other equilibria.",
     "Nothing is to be done. More increments, and a second mesh, show how far the answer depends on the path. "
     "A "
     "dilation angle nearer to friction makes it unique."},
    {"S551", "an element for small strain alone",
     "Large strain computes every group in the place that it has moved to. Solids of few nodes without "
     "enhanced strain can do that. Interfaces, structures, elements of flow and coupled elements cannot.",
     "Take one of the elements or formulations that the message lists, or small strain."},
    {"S552", "a law for small strain alone",
     "Large strain gives a law Kirchhoff stress and increments of the elastic logarithmic strain. The law must "
     "be isotropic, and its stress must have an elastic strain. Laws that follow increments of the total "
     "strain, and laws that change by point or stage, have none.",
     "Take an isotropic elastic or elastic-plastic law, or small strain."},
    {"S553", "a part of the model for small strain alone",
     "Pore water, stages that set displacements to zero, bounds and searches for a factor of safety assume "
     "that "
     "the model keeps the shape of its mesh.",
     "Leave the part out, or take small strain."},
    {"S554", "which stress and strain large strain prints",
     "Stresses are Cauchy stresses: force over present area. Strains are logarithmic (Hencky) strains of the "
     "left stretch, since the group was activated. Edge pressures stay normal to the moved edge and act on its "
     "present length. Point forces and weights keep their direction and their size.",
     "Nothing is to be done. Forces over the first area are nominal stresses: reports of nodes give forces."},
    {"S555", "an element turns inside out",
     "The step that failed moves a point or a corner of the element through one of its sides. At large strain "
     "that is a common end: beside a rough platen the free side rolls onto the platen, and the corner folds. "
     "The message names the element and the corner with the least share of its first area.",
     "Smaller increments help if the steps were large. A mesh with the corner cut or rounded, or with larger "
     "elements at the corner, goes further. A fold that is real needs contact, which the model does not have."},

    {"S570", "bounds need plane strain",
     "sagefe bounds solves the programs of limit analysis in plane strain. Its upper field has no hoop strain "
     "and its "
     "lower field no hoop stress.",
     "Use sagefe run or sagefe safety for the axisymmetric model."},
    {"S571", "bounds know no structures",
     "Limit analysis of this program has soil and interfaces. A bar, beam or spring has no place in its stress "
     "field.",
     "Remove the structure, or put its force on the ground as a pressure; sagefe safety takes structures."},
    {"S572", "the law has no bounds",
     "The theorems of limit analysis need a convex yield condition that does not change. sagefe bounds has "
     "Mohr-Coulomb, "
     "Tresca (phi = 0) and Drucker-Prager without tension cut-off in soil, and cohesion with friction in "
     "interfaces.",
     "Replace the material by mohr_coulomb with the strength that it has at failure."},
    {"S573", "the load is no traction",
     "A stress field can carry tractions on sides of elements, not a force or a movement at one point: below a "
     "point "
     "the ground yields at any load.",
     "Use a pressure card, forces on all nodes of the loaded sides, or movements of whole sides."},
    {"S574", "there is nothing to be bounded",
     "The chosen stage does not exist, has no soil, or adds nothing that could be multiplied.",
     "Choose another stage with --stage, or the factor of safety with --of strength."},
    {"S575", "a bound was not found",
     "One of the two programs ended without a field that passed the check of equilibrium and yield, or of the "
     "flow rule. "
     "The message has the reason.",
     "Bounds on a load exist only where the fixed loads leave a reserve of strength; --of strength bounds the "
     "factor of "
     "safety of ground that fails. Another mesh (--elements, --refine) helps where the optimisation ended "
     "early."},
    {"S576", "the mesh does not suit bounds",
     "Both fields need a mesh whose elements meet along whole sides, and interfaces with soil on both sides.",
     "Divide the elements so that no node lies within a side of another; bond an interface that lies on no "
     "soil to "
     "soil."},
    {"S577", "the pore pressure has no bounds",
     "Bounds need pore pressures that are given: lines, r_u, values at nodes, or heads of flow elements at the "
     "start of the stage. Those of elements that solve for the pressure of pore water depend on the load path.",
     "Mend the stages before, or give the pressures at nodes. In place of consolidation use the undrained "
     "strength."},
    {"S578", "finite elements contradict the bounds",
     "With psi = phi no equilibrium was found at a factor of safety below the lower bound, whose stress field "
     "is "
     "in equilibrium. One of the two is wrong.",
     "Search with more iterations: sagefe safety DECK --iterations 200. Compare the loads and supports of "
     "both."},

    {"S579", "the times of a stage of consolidation do not fit",
     "The fields time_error, end_degree, end_pressure and output_times of a stage need pore_water 2, values in "
     "their "
     "range, and theta blank beside time_error. A stage that ends by degree or pressure changes no load, "
     "support or "
     "group: such changes take the whole duration. A history of a support or load of excess_pressure is pairs "
     "of "
     "a time and a share of the value, with ascending times.",
     "Correct the field, or put the load into a stage of its own before the wait "
     "(docs/manual/consolidation.md)."},
    {"S580", "how a stage of consolidation ended",
     "A stage with end_degree or end_pressure ends behind the first step that reaches it. As a warning: its "
     "duration "
     "was over before.",
     "Where the duration was too short, make it longer."},

    // S6: results, checkpoints and result files.
    {"S585", "initial stresses raise the preconsolidation pressure",
     "The parameters state a preconsolidation pressure whose surface lies inside the initial stress. At "
     "those points the surface is enlarged until the stress lies on it: normally consolidated soil.",
     "Check p_c and the initial stress against each other. An ocr or a pop in place of p_c follows the "
     "initial stress."},
    {"S586", "a group of soil has no initial stress, and its law can't start without",
     "Stiffness and strength of the law grow with the mean stress; without any there is neither.",
     "Give an initial card of kind 0 or 1 for the group (for a group that is activated later, among the "
     "cards of that stage)."},
    {"S587", "a note about a law",
     "Something that follows from the way the law is meant, such as stiffness that is not derived from an "
     "energy.",
     "Nothing has to be done; docs/theory has the page of the law."},
    {"S590", "a card is not in its columns and was left as it is",
     "sagefe align found values beside their columns. More than one set of fields can hold them, or none can.",
     "Write 0 for each blank field of the card, or move the values by hand; sagefe echo shows the columns."},
    {"S600", "the error of steps in time",
     "Steps of a stage with time_error are chosen by a bound on the error of each. Errors die out as pressures "
     "do, so "
     "their sum is a bound on the error at every time of the stage.",
     "Nothing has to be done. A smaller time_error gives a smaller sum, by more steps."},
    {"S601", "a result can't be written",
     "The disk is full, the folder may not be written to, or there is a folder or a device of that name. "
     "The message gives the system's reason.",
     "Free space or choose another folder (-o). sagefe run --restart goes on from the last checkpoint."},
    {"S602", "a result would take the place of another file",
     "The file to be written is one that the same command reads, or two of its results would bear the same "
     "name: "
     "results are called after the deck's folder or file.",
     "Another output folder (-o) or another name; decks of one name in commands of their own."},
    {"S603", "another run is writing there",
     "A run locks the names of its results. Another process is at work with the same folder and deck "
     "name, perhaps one in the background.",
     "Wait for its end, stop it, or choose another folder (-o). The lock goes with its process, also "
     "after a crash."},
    {"S604", "the picture can't be converted",
     "PDF and PNG are made of SVG by the program rsvg-convert, which is not there or failed.",
     "Install librsvg2-bin, or take --format svg."},
    {"S605", "the library of result files crashed",
     "HDF5 crashes where an allocation fails, as it does under a limit on memory (ulimit -v, ulimit -d). The "
     "program lets it write in a process of its own then, and goes on without that file.",
     "Raise the limit, or run without --result; --vtu needs less memory."},
    {"S606", "a cell of a table is no number",
     "A column that is drawn has words, nan or inf in some rows: the file is damaged, or the cells are no "
     "numbers "
     "on purpose.",
     "Look at the line that the message names; write the table anew if it should have a number there."},
    {"S607", "a curve of sagefe drive ends early",
     "The law found no state for the next step, or the test can't be followed with these parameters. The table "
     "and the plot have the steps before it; the exit code is 3.",
     "The reason in the message says which step. Smaller steps (--steps) or a shorter path (--to) may help."},
    {"S608", "the list of an earlier run's files is damaged",
     "STEM.files, by which a run removes what an earlier run of the same name left, was cut or changed. Files "
     "of "
     "that run may stay beside the new ones.",
     "Remove the files that the message names if you do not need them."},
    {"S609", "a table may be cut short",
     "The last line of a table that a run wrote has no end: the file was copied or written in part.",
     "Copy it again, or run the deck again."},
    {"S610", "a field asked for has no place in the outputs",
     "The field lives at nodes or points, and no output of this run shows values there.",
     "Add --nodes, --points or --result, or take the field out of --field."},
    {"S611", "a law can't have the parameters that its place or stage gives it",
     "A parameter that grows with depth leaves the range of its law somewhere in the group, or a law with many "
     "history variables follows another one.",
     "Change the growth or the level, so that the parameter stays in its range in the whole group."},
    {"S612", "the stress lies outside the yield surface of a new law",
     "A group goes on with another material, and the stress that it keeps is more than that one carries. At "
     "the "
     "start of the stage the stress of such points returns to the surface, as an elastic trial stress would; "
     "the "
     "forces that this leaves unbalanced are let go over the increments of the stage.",
     "Look at the displacements of the stage. If the stress should fit, correct the strength."},
    {"S613", "a node is held by nothing during lock-off",
     "In the stage of lock-off the force of a bar is held and the bar has no stiffness.",
     "Support the node at the far end of the bar, or make the free length of the anchor one element."},
    {"S614", "a card about the law of a group does not fit",
     "Lock-off is for bars and springs in a stage; another material and its group must have laws for the same "
     "kind "
     "of element; a parameter must be one of the law's; and the group must be there in the stage.",
     "Correct the card; `sagefe list materials` shows laws and their parameters."},
    {"S615", "the unit weight does not change with the material",
     "A group that goes on with another material keeps the weight with which it was loaded.",
     "Give both materials the same unit weight, or add the difference as a load."},
    {"S616", "a movement has no factor of safety",
     "Supports that move press on the ground with whatever force it can carry: with less strength that force "
     "is "
     "smaller, and the ground never fails.",
     "Bound the force with --of load; or choose a stage in which loads act, with --stage."},
    {"S617", "the value can't differ from place to place",
     "A random field is of a parameter of a law: every point has its own. Loads, unit weights and elements of "
     "flow "
     "have none.",
     "Leave correlation_length out, or name a parameter: material.NAME.PARAMETER (sagefe list materials)."},
    {"S620", "sagefe report found no result file",
     "A page is made of the result file of a run, STEM.h5, and of the tables and the listing beside it. A "
     "plain "
     "sagefe run writes no result file.",
     "Run the deck with sagefe run DECK --report, which writes the page too, or with --result; then give "
     "sagefe report the name of the file."},
    {"S621", "a page lacks something for want of room",
     "A page holds its data itself and is meant to be sent and opened quickly: about 4 MB a run. Fields, "
     "states or "
     "rows that do not fit are left out; the message and the page say which.",
     "sagefe report --size MB gives the page more room, --field NAME keeps the fields that matter."},
    {"S622", "no run of the page has the field",
     "The name is not one of the fields at nodes or integration points that the runs have, or it is one that "
     "the "
     "page makes itself of the stress (mean, deviator, principal stresses).",
     "Take a name of the list in the message; stress, strain and displacement have all their components."},
    {"S630", "the checkpoint does not fit",
     "It is of another deck, other options, other outputs or another build, or files it goes on from "
     "have been changed since. Going on would mix two runs.",
     "Run the deck again without --restart; or restore deck, options and program as they were."},
    {"S631", "the checkpoint can't be read", "The file is damaged, cut short or not a checkpoint.",
     "Run the deck again without --restart."},
    {"S632", "how a run goes on from what an earlier one left",
     "There was no checkpoint, or bytes behind it were cut off and are written anew, or a file of an "
     "earlier run has been changed since and stays where it is.",
     "Nothing: the results are those of a run without interruption. Remove a file that stays if it is "
     "not needed."},
    {"S633", "an interrupted run could not stop by itself",
     "Ten seconds after Ctrl-C, or a request of the system to end, the program had still not stopped: a "
     "user routine, or the reading or writing of a file, did not return. The program then ended itself with "
     "exit code 5.",
     "Look for an endless loop in the user routine, or for a pipe (FIFO) that nobody reads or writes. "
     "sagefe run --restart goes on from the last checkpoint, if there is one."},
    {"S640", "a result file can't be used",
     "It is no result file of this program, damaged, or of a version in which its deck means another "
     "model.",
     "sagefe run DECK --result writes it anew; sagefe plot takes STEM.h5."},
    {"S641", "a table can't be read",
     "A CSV table needs a line with the names of its columns, and as many cells in each line.",
     "Take the tables as the program wrote them; a spreadsheet must save them with commas and points."},
    {"S642", "a column is not in the table",
     "--xy names columns of the tables; this one is in none of those given.",
     "Take a name from the list in the message; head -1 TABLE shows them too."},
    {"S643", "the result file has no such state",
     "--at of a plot names a stage and increment, a strain or a load factor that the run did not write; "
     "or --states of a run asks for one at which no increment ends, and the nearest is written.",
     "Take one from the list in the message, or sagefe run --result --states for just that state."},
    {"S644", "a field is unknown or can't be drawn",
     "Fields are named as sagefe list fields shows them; histories by the names of the deck's laws. A "
     "picture needs a field of nodes or points that some element of the deck has.",
     "Take a name from the list."},
    {"S645", "there is nothing to plot",
     "The model has no interface, the line meets no element, or no field was named.",
     "Name what is to be drawn; check the coordinates of the line against the mesh."},
    {"S646", "units differ",
     "Two runs, or two columns, are in different units. On one axis or one scale they would look alike where "
     "they "
     "are not.",
     "Draw them in separate files, or write one of the decks in the units of the other."},
    {"S650", "a path or test can't be followed as it is given",
     "The columns of a path file must be those of the law (components of stress or strain, one of the "
     "two for each), with a number in each cell.",
     "Correct the file: docs/manual/drive.md lists the columns. A blank cell in a column that is "
     "controlled is not a zero."},
    {"S651", "the law to be driven is not given whole",
     "A law is given by its name and its parameters by name; one is missing, misspelt, or given no "
     "number.",
     "sagefe list materials shows names and parameters; --set NAME=VALUE gives each, or --deck takes "
     "them from a deck."},
    {"S660", "the fit can't be made as asked",
     "A fit needs free parameters that the law has, bounds around their start, and curves with the "
     "driven column first and more points than parameters.",
     "Correct what the message names; docs/manual/drive.md shows the columns of a curve and the form "
     "--free NAME=LOW:HIGH."},

    // S7: decks of other programs, meshes, and writing for others.
    {"S701", "the deck's own counts and lists contradict each other",
     "A deck of another program describes its mesh by counts and lists (columns and rows, coordinates, "
     "materials of elements), and these do not agree, or give a body that can't be.",
     "Correct the list that the message shows; sagefe echo DECK prints each value with its name."},
    {"S702", "a feature of that program is not taken over",
     "The deck of another program uses generation, turned supports or options that are read but not "
     "translated.",
     "Write the generated cards out, one by one, in the program the deck is from, or in the deck."},
    {"S703", "a law of another program is replaced",
     "The deck's soil law has no exact counterpart; the message says what stands for it and what is "
     "missing.",
     "Check its parameters on the converted deck (sagefe convert DECK own.dat), and choose another law "
     "there if needed."},
    {"S704", "a mesh was translated with a change",
     "Elements were turned round, degenerate ones became triangles, nodes of no element were left out, or a "
     "boundary without a counterpart became a support.",
     "Nothing, where the message describes what is meant; look at the picture of the mesh."},
    {"S705", "load factors of another program",
     "Load factors or a method of that program are applied in another way than its name suggests; the "
     "message says how.",
     "Compare loads of each stage in the listing with what the deck is meant to say."},
    {"S710", "a mesh file can't be read",
     "The file is no Gmsh mesh of version 4.1 or 2.2 and no Abaqus or CalculiX input, is cut short, or holds "
     "elements or keywords that are not supported.",
     "Correct the line that the message names. From Gmsh save with Mesh.MshFileVersion = 4.1, as triangles or "
     "quadrilaterals. Write files that *INCLUDE names, and generated nodes and elements, into the file."},
    {"S711", "the mesh holds no surface",
     "Only curves and points are in the file: physical groups of curves alone, or the mesh was not made "
     "in two dimensions.",
     "Mesh in two dimensions, and give the surfaces a physical group, or save all elements (Mesh.SaveAll "
     "= 1)."},
    {"S712", "a constant of the mesh's material is out of range",
     "A mesh carries no material, so options give one; this value can't be.",
     "Young's modulus above 0, Poisson's ratio between -1 and 0.5."},
    {"S713", "a part of the mesh is left out",
     "Named curves become supports, pressures, structures and water lines by options or by their names, and "
     "this "
     "name has no such meaning, or the curve lies on no element. Elements of other types and keywords besides "
     "nodes, elements, sets and surfaces are left out too.",
     "Use the curve with --fix, --pressure, --beam, --bar or --water of sagefe convert, or name it fix_x, "
     "fix_y, "
     "fix_xy or pressure=VALUE in the mesh."},
    {"S714", "the two sides of a joint do not match",
     "Lines named interface_bottom=NAME and interface_top=NAME are the two sides of one joint: each line needs "
     "a "
     "partner at the same place with as many nodes, of its own side's nodes.",
     "Mesh both sides alike (the same transfinite numbers, or one curve periodic to the other), with nodes of "
     "their "
     "own: Gmsh's plugin Crack makes them from one curve."},
    {"S720", "something is left out of the written file",
     "The format written to has no place for it, or less digits. The new file describes another problem, "
     "or the same one with less accuracy.",
     "Add it by hand in the other program where it matters, or convert to .dat, which keeps most."},
    {"S721", "something is left to the other program",
     "Integration, solver or control of the iterations are chosen by the program that reads the file; "
     "results can differ a little.",
     "Nothing; for comparing digits use elements whose integration is the same (reduced 8-node "
     "elements)."},
    {"S722", "the model does not fit sage1 cards",
     "An element has more nodes, or a number more digits, than a card's columns hold.",
     "Convert to .msh or .inp, or write the numbers with fewer digits."},
    {"S723", "the other program would write over a file",
     "CalculiX names its results after its input, and a file of that name is there already.",
     "Convert to the name in the message."},
    // S73: models with other values, from Python and in sweeps.
    {"S730", "the model has no number of that name",
     "Names of numbers are made of the deck's materials, stages, reports and the parameters of its laws; a "
     "sweep or "
     "a program names one that this deck lacks.",
     "Take the name that the message proposes; docs/manual/python.md lists how names are made, and "
     "Model.names() "
     "lists those of a deck."},
    {"S731", "the value can't be given to that name",
     "A number was expected and the value is none, or is not finite, or counts something and is not whole; or "
     "the "
     "name takes one of a few words.",
     "Give what the message wants."},
    {"S732", "the study of a sweep can't be used",
     "The TOML file of the study has a mistake at that line, an unknown key, or says too little.",
     "docs/manual/sweep.md shows what a study holds."},
    {"S733", "a law written in Python raised an exception",
     "The function that Python gave as a law ended with an exception or returned something else than stress, "
     "tangent "
     "and history of the right shapes. A program in Python gets the exception itself.",
     "Mend the function; Law(NAME).drive() tries it without a mesh."},
    {"S734", "a sweep names what the deck does not read or give",
     "A quantity or a name is none of the deck's, or no value of it changes the model: a parameter of a "
     "material that no "
     "group has, for example. Every case would have the same answer.",
     "Take the name that the message proposes, or leave it out."},
    {"S737", "a tool that should start the parts of a sweep is missing or failed",
     "--parallel needs GNU parallel, --slurm needs sbatch. Where parts failed, the cases that they left are "
     "computed by "
     "the process that merges the table.",
     "Install the tool, or leave the option out; the logs in the output folder say more."},
    {"S738", "another sweep works on this study",
     "The file with finished cases is in use by another process with the same study and output folder.",
     "Wait for it, or give another folder, -o."},
    {"S739", "a named part of the mesh can't be used so",
     "An option of sagefe convert names a curve, point or set that the mesh lacks, or one that does not fit "
     "the "
     "use. A force needs one node. A structure and a pressure need lines. A water line has one height for each "
     "x.",
     "Choose one of the names that the message lists, or another option."},
    {"S741", "partial factors are in force",
     "The option --factors multiplies loads and divides strengths of the deck; the note says by how much. "
     "Section "
     "forces in the files of one set are those of the calculation; the table of all sets has them times the "
     "factor on effects.",
     "Nothing, where that is meant. --variable N names the stages whose loads are variable."},
    {"S742", "the sets of partial factors do not fit",
     "The command computes one set at a time and --factors gives several, or --variable or --structural names "
     "a "
     "stage that the deck lacks.",
     "Give one set, or a stage of the deck. sagefe run and sagefe safety accept several sets."},
    // S8: pieces from outside of the program.
    {"S801", "the deck needs a plug-in that is not loaded",
     "A line \"* plugin: NAME\" before the first card names a plug-in that the deck was written for. A deck "
     "never loads a library by itself: whoever runs it decides which code of others is executed.",
     "Give --plugin LIBRARY with the library that has this name; sagefe list plugins --plugin LIBRARY shows "
     "name and pieces of a library."},
    {"S802", "a library is no plug-in that can be used",
     "The file is no library, misses another library that it was linked to, or has no entry point "
     "sage_plugin_v1. Or it was built by another compiler or for another version of the program; the message "
     "names the field and both values. Or it crashed or gave up when it had to give its pieces.",
     "Build it against the installed package of this very program (sage_add_plugin in CMake, "
     "docs/manual/plugins.md) with the compiler that the message names; ldd LIBRARY shows missing libraries, "
     "sagefe conform LIBRARY tries its pieces."},
    {"S803", "two pieces have the same code or name",
     "A law, element, solver or field of a plug-in has a code or a name that is taken by the program or by "
     "another plug-in, so that a card could mean either.",
     "Change code or name in one of the two plug-ins; codes from 1000 are free, and each author best takes a "
     "range of his own."},
    {"S804", "the routine of a UMAT can't be had",
     "A material of law umat has no routine, or the library of --umat can't be loaded, or has no symbol umat_, "
     "umat or UMAT.",
     "Give --umat LIBRARY for all such materials, or --umat MATERIAL=LIBRARY for one; LIBRARY:SYMBOL names a "
     "routine that is called otherwise (nm -D LIBRARY lists names). Fortran: gfortran -shared -fPIC."},
    {"S805", "a number of a umat material does not fit",
     "The material card of a UMAT begins with the number of stress components (4 or 6), the number of state "
     "variables and two marks: symmetric (0, 1 or 2) and safe for threads (0 or 1); the routine's properties "
     "follow.",
     "Compare the card with the routine's own documentation: NTENS, NSTATV (the DEPVAR of an Abaqus deck), "
     "PROPS."},
    {"S806", "a UMAT did not do what it must",
     "The routine wrote beyond one of its arrays, ended the program (XIT, STOP, exit), returned what is no "
     "number, or gave an unsymmetric matrix though the card calls it symmetric. Nothing of that step is kept.",
     "sagefe conform --umat LIBRARY drives the routine alone and says what is wrong with it. Too few state "
     "variables or properties on the card are the most frequent cause of writing beyond an array."},
    {"S807", "`sagefe new` can't write its file or folder",
     "The file exists already, the folder is not empty, or the templates of the program are not where they "
     "were "
     "installed.",
     "Choose another name or folder, or empty it; where the templates are missing install the program anew."},
    {"S808", "the suites that try pieces are not there",
     "sagefe conform runs a second program, which is built only where GoogleTest was found.",
     "Install GoogleTest (libgtest-dev), build and install the program again."},
    {"S809", "a user material printed something, or needs a look",
     "A UMAT wrote text, called for something that this program does not offer, or returned a DDSDDE that is "
     "not the derivative of its stress; the run went on. Routines print when they meet a state that they were "
     "not "
     "written for, or while their author looks for a fault.",
     "Read the log that the message names. Lines that a routine prints at every point slow a run down much: "
     "take them out. Where equilibrium comes slowly, symmetric = 2 on the card has differences of the stress "
     "taken in place of DDSDDE (docs/manual/umat.md)."},
    {"S810", "a piece crashed under the checks",
     "A law or element of the library ended the program that tries it, mostly by writing or reading beyond an "
     "array, or by a division of integers by zero.",
     "The last line above names what was tried. Build the library with -g -fsanitize=address, or run "
     "sagefe conform LIBRARY under gdb or valgrind: they show the line."},

    // S9: the command line.
    {"S901", "there is no such command", "The first word behind the program's name says what is to be done.",
     "sagefe --help lists the commands; the usual one is sagefe run DECK."},
    {"S902", "an option or word is not known",
     "The command has no such option, or takes no further word. Options of one command are not those of "
     "another.",
     "sagefe COMMAND --help, or man sagefe-COMMAND."},
    {"S903", "something is missing on the command line",
     "A deck, a file or the value of an option is wanted and not there.",
     "sagefe COMMAND --help shows the order: what stands in brackets can be left out."},
    {"S904", "an option's value is rejected",
     "The value is none of those known, no number, out of range, or a file that is not there.",
     "The message says what is wanted; values with blanks need quotes."},
    {"S905", "options do not go together", "Two options exclude each other, or one needs another.",
     "Give one of them, or both that belong together; the help of the command says which."},
    {"S906", "a warning counts as an error",
     "--strict was given, and the deck or its run has warnings. Those of a run come while it computes; its "
     "results are "
     "complete then, and the exit code is 2.",
     "Mend what they say, or leave out --strict."},
    {"S907", "the command needs what the deck lacks",
     "--converge and --follow work on numbers of reports, compare on points of both meshes; the deck has "
     "none, or none with a value at the end.",
     "Add a report card, name one that the message lists, or a point in both meshes."},
    {"S908", "the deck can't come from a pipe here",
     "The command reads its deck more than once, which a pipe can't give.", "Save the deck to a file first."},
    {"S909", "an option does nothing here",
     "Together with the others the option has no effect: --converge writes its table, not the files of a "
     "run.",
     "Run the deck again with the options that the last line of the table shows."},
    {"S910", "there is no such code",
     "sagefe explain takes a code as messages print it in brackets, such as S501.",
     "sagefe explain lists all codes; sagefe explain --search WORD looks in their texts."},
    {"S911", "standard output was lost",
     "The program that read the output ended, or its disk is full; results in files are not touched.",
     "Write to a file with room (> FILE), and look at it with less."},
    {"S912", "the program behind a command is not there",
     "sagefe figures, stress and verify are done by the programs sagefe-figures, sagefe-stress and "
     "sagefe-verify, which "
     "lie in the folder of the program sagefe, no other. A build for use alone has none of them.",
     "cmake builds them with -DSAGE_STUDIES=ON, and so does scripts/test (docs/manual/verify.md)."},
};

}  // namespace

std::span<const MessageEntry> messages() {
  return kMessages;
}

const MessageEntry* find_message(int number) {
  const auto* found =
      std::ranges::find(kMessages, number, [](const MessageEntry& m) { return m.code.number(); });
  return found != std::end(kMessages) ? found : nullptr;
}

const char* section_of(const MessageEntry& message) {
  return kSections[message.code.number() / 100 - 1];
}

}  // namespace sage
