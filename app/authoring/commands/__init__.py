"""Everything that a user can do to a document: one small frozen class each, applied by `session.apply(command)`."""

from __future__ import annotations

from .adding import AddCodeFile, AddGroupFile, AddMatte, AddNode, DropFiles, InsertNode, SpliceChain
from .clipboard import CutSelection, DuplicateSelection, PasteText
from .coding import EmbedCode, LinkCodeFile, SetCode
from .command import EditCommand, Edited
from .decor import AddComment, AddDot, AddFrame, EditComment, EditFrame, JoinDot, RemoveDot, ResizeComment, ResizeFrame
from .ends import KEEP, AddInput, AddOutput, Keep, RemoveEnd, RenameEnd, SetInput, SetOutput
from .grouping import LinkGroup, MakeGroup, MakeGroupLocal, Ungroup
from .keys import AnimateValue, AnimateValues, BakeKeys, RemoveKey, SetExpression, SetKey, ToggleKey
from .layout import AlignSelection, ArrangeElements, MoveElements, PlaceElement
from .linking import (
    Connect,
    CutLinks,
    DeleteSelection,
    Disconnect,
    DisconnectAll,
    ExtractSelection,
    MoveLink,
    RenameNode,
    ReplaceNode,
    SwapInputs,
    ToggleCollapse,
    ToggleMute,
)
from .settings import SetCanvasSize, SetColorSettings, SetFrameRange, SetFrameRate, SetPreroll
from .values import DescribeControl, ExposeValue, HideControl, RenameControl, ResetNode, ResetValue, SetValue, SetValues
from .viewing import AssignViewer, ReplaceDocument, ReplaceGraph

__all__ = [
    "KEEP",
    "AddCodeFile",
    "AddComment",
    "AddDot",
    "AddFrame",
    "AddGroupFile",
    "AddInput",
    "AddMatte",
    "AddNode",
    "AddOutput",
    "AlignSelection",
    "AnimateValue",
    "AnimateValues",
    "ArrangeElements",
    "AssignViewer",
    "BakeKeys",
    "Connect",
    "CutLinks",
    "CutSelection",
    "DeleteSelection",
    "DescribeControl",
    "Disconnect",
    "DisconnectAll",
    "DropFiles",
    "DuplicateSelection",
    "EditCommand",
    "EditComment",
    "EditFrame",
    "Edited",
    "EmbedCode",
    "ExposeValue",
    "ExtractSelection",
    "HideControl",
    "InsertNode",
    "JoinDot",
    "Keep",
    "LinkCodeFile",
    "LinkGroup",
    "MakeGroup",
    "MakeGroupLocal",
    "MoveElements",
    "MoveLink",
    "PasteText",
    "PlaceElement",
    "RemoveDot",
    "RemoveEnd",
    "RemoveKey",
    "RenameControl",
    "RenameEnd",
    "RenameNode",
    "ReplaceDocument",
    "ReplaceGraph",
    "ReplaceNode",
    "ResetNode",
    "ResetValue",
    "ResizeComment",
    "ResizeFrame",
    "SetCanvasSize",
    "SetCode",
    "SetColorSettings",
    "SetExpression",
    "SetFrameRange",
    "SetFrameRate",
    "SetInput",
    "SetKey",
    "SetOutput",
    "SetPreroll",
    "SetValue",
    "SetValues",
    "SpliceChain",
    "SwapInputs",
    "ToggleCollapse",
    "ToggleKey",
    "ToggleMute",
    "Ungroup",
]
