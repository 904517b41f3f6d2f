; The installer for Windows, by Inno Setup 6:
;   iscc /DVersion=0.1.0 /DFolder=C:\build\halation tests\application\windows.iss
; Untested so far. It installs for one user, needs no administrator, and writes halation-VERSION-windows-setup.exe.
#ifndef Version
  #error Give the version: /DVersion=0.1.0
#endif
#ifndef Folder
  #error Give the folder with halation.exe: /DFolder=C:\build\halation
#endif

[Setup]
AppId={{6C1F1B52-4C9C-4E0B-9E0D-9C2B7B0B6A51}
AppName=Halation
AppVersion={#Version}
AppPublisher=Halation
DefaultDirName={autopf}\Halation
DefaultGroupName=Halation
DisableProgramGroupPage=yes
PrivilegesRequired=lowest
ArchitecturesAllowed=x64compatible
ArchitecturesInstallIn64BitMode=x64compatible
ChangesEnvironment=yes
LicenseFile=..\..\LICENSE
OutputBaseFilename=halation-{#Version}-windows-setup
Compression=lzma2
SolidCompression=yes
UninstallDisplayIcon={app}\halation.exe

[Tasks]
Name: "path"; Description: "Add the command halation to PATH"; Flags: unchecked

[Files]
Source: "{#Folder}\*"; DestDir: "{app}"; Flags: ignoreversion recursesubdirs

[Icons]
Name: "{group}\Halation"; Filename: "{app}\halation.exe"; Parameters: "edit"

[Registry]
Root: HKCU; Subkey: "Environment"; ValueType: expandsz; ValueName: "Path"; ValueData: "{olddata};{app}"; Tasks: path; Check: IsNotInPath(ExpandConstant('{app}'))

[Code]
function IsNotInPath(Folder: string): Boolean;
var
  Path: string;
begin
  if not RegQueryStringValue(HKEY_CURRENT_USER, 'Environment', 'Path', Path) then
    Path := '';
  Result := Pos(';' + Uppercase(Folder) + ';', ';' + Uppercase(Path) + ';') = 0;
end;
